#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/studies/operating_room/ports.hpp>

namespace trocar::studies {
namespace {

constexpr double kDeg = portable::pi / 180;
constexpr double kBestManipulation = 60 * kDeg, kBestElevation = 60 * kDeg;  // [Hanna, Shimi & Cuschieri 1997]
constexpr double kManipulationWidth = 20 * kDeg, kAzimuthWidth = 30 * kDeg, kElevationWidth = 35 * kDeg;
constexpr double kMostLean = 60 * kDeg, kLeastDepth = 0.02, kMostDepth = 0.25;
constexpr double kEnough = 0.04;                         // clearance [m]
constexpr double kHandle = 0.10, kHandleRadius = 0.035;  // of a hand at a handle [m]
constexpr double kScopeOut = 0.15;
constexpr double kArmsEnough = 0.02;  // clearance of arms [m]
constexpr double kBlockedCosts = 0.9;
constexpr double kSetUpTurns[] = {20 * kDeg, -20 * kDeg, 40 * kDeg, -40 * kDeg};
constexpr int kLookedAt = 4;  // times as many sets are tried with arms as are reported

Vec3d unit_of(Vec3d v) { return v / length(v); }
double bell(double off, double width) { return portable::exp(-(off / width) * (off / width)); }
double enough(double clearance) { return std::clamp(clearance / kEnough, 0.0, 1.0); }

/// Corners and middle of the box.
std::vector<Vec3d> points_of(const PortPlanOptions& o) {
  std::vector<Vec3d> points{0.5 * (o.low + o.high)};
  for (int k = 0; k < 8; ++k)
    points.push_back({k & 1 ? o.high.x : o.low.x, k & 2 ? o.high.y : o.low.y, k & 4 ? o.high.z : o.low.z});
  return points;
}

/// Of a direction in the patient's plane from the optical axis, to the left above 0.
double azimuth_of(Vec3d shaft, Vec3d optical) {
  const double sine = optical.x * shaft.y - optical.y * shaft.x, cosine = optical.x * shaft.x + optical.y * shaft.y;
  return portable::atan2(sine, cosine);
}

PlacedShape handle_of(Vec3d port, Vec3d target, double whole) {
  const Vec3d out = unit_of(port - target), end = target + whole * out;
  return {false, end - kHandle * out, end, kHandleRadius, Mat3d::identity()};
}

/// What two arms do at the target's points.
struct ArmsThere {
  double reach = 0, clearance = 0;
  double worth() const { return reach * std::clamp(clearance / kArmsEnough, 0.0, 1.0); }
};

/// The room's two first arms at a pair's ports, their bases turned about these.
ArmsThere arms_at(const RoomModel& model, const PortPlan& plan, const PortPair& pair, const double (&turned)[2]) {
  scene::Room room = model.room();
  const Vec3d places[2] = {plan.candidates[std::size_t(pair.left)].place,
                           plan.candidates[std::size_t(pair.right)].place};
  const Vec3d normals[2] = {plan.candidates[std::size_t(pair.left)].normal,
                            plan.candidates[std::size_t(pair.right)].normal};
  for (int k = 0; k < 2; ++k) {
    const int port = room.port(room.arms[std::size_t(k)].port);
    room.ports[std::size_t(port)].position = places[k];
    scene::RoomArm& arm = room.arms[std::size_t(k)];
    arm.out = unit_of(unit_of(places[k] - plan.target) + normals[k]);
    arm.base = kinematics::turn_about(arm.out, turned[k]) * arm.base;
  }
  const RoomModel there(std::move(room));
  RoomPose pose = there.start();
  ArmsThere out{0, 1e9};
  for (int k = 0; k < 2; ++k)
    if (there.beyond_set_up(k) > 0) return {};
  int reached = 0;
  for (const Vec3d& p : plan.points) {
    bool both = true;
    for (int k = 0; k < 2; ++k) both = there.lead(pose, k, {.tip = p}).reached && both;
    reached += both;
    if (const std::vector<Near> nearest_now = there.nearest(pose); !nearest_now.empty())
      out.clearance = std::min(out.clearance, nearest_now.front().distance);
  }
  out.reach = double(reached) / double(plan.points.size());
  return out;
}

/// As the room has their bases; where that is not all that can be, each base in turn, the other as it is best so far.
void judge_arms(const RoomModel& model, const PortPlan& plan, bool set_up, PortPair& pair) {
  double turned[2] = {0, 0};
  ArmsThere best = arms_at(model, plan, pair, turned);
  for (int k = 0; set_up && k < 2 && best.worth() < 1; ++k) {
    double kept = turned[k];
    for (const double turn : kSetUpTurns) {
      turned[k] = turn;
      const ArmsThere now = arms_at(model, plan, pair, turned);
      if (now.worth() > best.worth()) best = now, kept = turn;
    }
    turned[k] = kept;
  }
  pair.with_arms = true;
  pair.arms_reach = best.reach;
  pair.arms_clearance = best.clearance;
  for (int k = 0; k < 2; ++k) pair.turned[k] = turned[k];
}

}  // namespace

PortCandidate judge_port(const RoomModel& model, const PortPlanOptions& o, Vec3d scope, Vec3d place) {
  PortCandidate c;
  c.place = place;
  c.normal = model.figure().normal(place.x, place.y);
  const std::vector<Vec3d> points = points_of(o);
  int reached = 0;
  for (const Vec3d& p : points) {
    const double depth = length(p - place), lean = portable::acos(dot(unit_of(place - p), c.normal));
    reached += depth >= kLeastDepth && depth <= std::min(kMostDepth, o.length - 0.05) && lean <= kMostLean;
  }
  c.reach = double(reached) / double(points.size());
  const Vec3d out = unit_of(place - points[0]);
  c.depth = length(place - points[0]);
  c.lean = portable::acos(dot(out, c.normal));
  c.elevation = portable::asin(out.z);
  c.azimuth = azimuth_of(points[0] - place, points[0] - scope);
  c.lever = c.depth / std::max(1e-6, o.length - c.depth);
  const double halved = portable::log(std::max(1e-6, c.lever)) / portable::log(2.0);  // at 1 octave a half
  c.ways = ways_in(o.organs, place, points);
  c.alone = (1 - kBlockedCosts * c.ways.blocked) * c.reach * bell(c.elevation - kBestElevation, kElevationWidth) *
            portable::exp(-0.6931 * halved * halved);
  return c;
}

PortPair judge_pair(const RoomModel& model, const PortPlanOptions& o, Vec3d scope, const PortCandidate& left,
                    const PortCandidate& right) {
  PortPair pair;
  const Vec3d target = points_of(o)[0];
  pair.manipulation = portable::acos(dot(unit_of(left.place - target), unit_of(right.place - target)));
  const PlacedShape l = handle_of(left.place, target, o.length), r = handle_of(right.place, target, o.length);
  const Vec3d back = unit_of(scope - target);
  const PlacedShape s{false, scope + 0.05 * back, scope + kScopeOut * back, 0.025, Mat3d::identity()};
  pair.clearance = std::min({studies::clearance(l, r), studies::clearance(l, s), studies::clearance(r, s)});
  pair.patient_clearance =
      std::min(model.figure().distance(l.a, l.b, l.radius), model.figure().distance(r.a, r.b, r.radius));
  // to both sides of the optical axis, by equal angles: a shaft from the left points to the right
  const double off = left.azimuth + right.azimuth;
  const bool sides = left.azimuth < 0 && right.azimuth > 0;
  pair.score = std::sqrt(left.alone * right.alone) * bell(pair.manipulation - kBestManipulation, kManipulationWidth) *
               (sides ? bell(off, kAzimuthWidth) : 0.15 * bell(off, kAzimuthWidth)) * enough(pair.clearance) *
               enough(pair.patient_clearance);
  return pair;
}

PortPlan plan_ports(const RoomModel& model, const PortPlanOptions& o) {
  const int scope = model.room().port(o.scope);
  if (scope < 0) throw std::invalid_argument(tr("there is no port \"{}\"", o.scope));
  PortPlan plan;
  plan.scope = model.room().ports[std::size_t(scope)].position;
  plan.points = points_of(o);
  plan.target = plan.points[0];
  plan.sight = ways_in(o.organs, plan.scope, plan.points);
  const int across = int(o.half_width / o.spacing), along = int((o.to - o.from) / o.spacing + 1e-9);
  for (int j = 0; j <= along; ++j)
    for (int i = -across; i <= across; ++i) {
      const double x = i * o.spacing, y = o.from + j * o.spacing;
      const Vec3d place{x, y, model.figure().front(x, y)};
      if (length(place - plan.scope) < o.apart) continue;
      plan.candidates.push_back(judge_port(model, o, plan.scope, place));
    }
  std::vector<PortPair> all;
  for (int l = 0; l < int(plan.candidates.size()); ++l)
    for (int r = 0; r < int(plan.candidates.size()); ++r) {
      PortCandidate &left = plan.candidates[std::size_t(l)], &right = plan.candidates[std::size_t(r)];
      if (l == r || left.alone <= 0 || right.alone <= 0 || length(left.place - right.place) < o.apart) continue;
      ++plan.looked_at;
      PortPair pair = judge_pair(model, o, plan.scope, left, right);
      pair.left = l;
      pair.right = r;
      left.best = std::max(left.best, pair.score);
      right.best = std::max(right.best, pair.score);
      if (pair.score > 0) all.push_back(pair);
    }
  std::stable_sort(all.begin(), all.end(), [](const PortPair& a, const PortPair& b) { return a.score > b.score; });
  const bool arms = model.arms().size() >= 2;
  for (const PortPair& pair : all) {  // neighbours of a set are no other set
    if (int(plan.pairs.size()) >= (arms ? kLookedAt * o.sets : o.sets)) break;
    const auto near = [&](int a, int b) {
      return length(plan.candidates[std::size_t(a)].place - plan.candidates[std::size_t(b)].place) < 1.6 * o.spacing;
    };
    if (std::any_of(plan.pairs.begin(), plan.pairs.end(),
                    [&](const PortPair& p) { return near(p.left, pair.left) && near(p.right, pair.right); }))
      continue;
    plan.pairs.push_back(pair);
  }
  for (PortPair& pair : plan.pairs) {
    pair.rank = pair.score;
    if (!arms) continue;
    judge_arms(model, plan, o.set_up, pair);
    pair.rank *= pair.arms_reach * std::clamp(pair.arms_clearance / kArmsEnough, 0.0, 1.0);
  }
  std::stable_sort(plan.pairs.begin(), plan.pairs.end(),
                   [](const PortPair& a, const PortPair& b) { return a.rank > b.rank; });
  if (int(plan.pairs.size()) > o.sets) plan.pairs.resize(std::size_t(o.sets));
  return plan;
}

}  // namespace trocar::studies
