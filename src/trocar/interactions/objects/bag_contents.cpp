#include <algorithm>
#include <cmath>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/objects/bag_contents.hpp>

namespace trocar::interactions {
namespace {

constexpr double kOverMouth = 0.050;    // [m] above the mouth, from where things come in
constexpr double kBandThick = 0.0012;   // [m] half the hoop's thickness
constexpr double kClothThick = 0.0008;  // [m] half the cloth's
constexpr double kTouchAhead = 0.0005;  // [m] touches are there before anything touches
constexpr double kAnotherSide = 0.012;  // [m] deeper is another part of the cloth ...
constexpr double kStillIn = 0.040;      // [m] ... but of what is inside, which has nowhere else to be
constexpr double kInMouth = 0.006;      // [m] about the mouth's plane: what lies there keeps the hoop open
constexpr double kLeavesBag = 0.002;    // [m] that what keeps it open is away from the hoop
constexpr double kBack = 0.0005;        // [m] above the mouth before what was inside has left ...
constexpr double kPouchBack = 0.003;    // ... and a node of a pouch, whose nodes are about 5 mm apart
// Of a pouch in the bag; a node of a gallbladder weighs some 2 mN.
constexpr double kPouchStiffness = 50;   // [N/m]
constexpr double kPouchDamping = 0.05;   // [N s/m]
constexpr double kDeepestPush = 0.0025;  // [m]
constexpr double kRubs = 0.15;           // Coulomb's coefficient of a pouch on cloth
constexpr double kCreeps = 0.005;        // [m/s] below it friction is viscous
constexpr std::uint64_t kLooks = 16;     // ticks in which the nearest node is looked for among all

/// A place as seen from the hoop's middle.
struct AtMouth {
  double height = 0, out = 0;  ///< above the mouth's plane; from its axis [m]
};
AtMouth at_mouth(const BagModel& m, const BagState& s, Vec3d p) noexcept {
  const Vec3d off = p - s.middle(m);
  const double height = dot(off, s.frame.up);
  return {height, length(off - height * s.frame.up)};
}

/// How far from the bag's axis its inside reaches, `below` the mouth: a sack of the cloth's girth that hangs from the
/// hoop, wide open or drawn shut [m]. Below 0: there is no more of it.
double reach_inside(const BagModel& m, const BagState& s, double below) noexcept {
  constexpr double kWidest = 0.35;  // of its depth: our estimate
  const double widest = kWidest * m.deep;
  if (below < widest) return m.hoop * (s.hoop + (1 - s.hoop) * std::max(0.0, below) / widest);
  const double f = (below - widest) / (m.deep - widest);
  return f < 1 ? m.hoop * std::sqrt(1 - f * f) : -1;
}

BagPoint::Where where_now(const BagState& s, double radius, double back, BagPoint::Where was, AtMouth at) noexcept {
  if (was == BagPoint::inside)
    return at.height > back && at.out < radius && !s.shut() ? BagPoint::over_mouth : BagPoint::inside;
  if (at.out >= radius || at.height > kOverMouth || s.shut()) return BagPoint::elsewhere;
  if (at.height > 0) return BagPoint::over_mouth;
  return was == BagPoint::over_mouth ? BagPoint::inside : BagPoint::elsewhere;
}

/// How far from its middle the hoop has to stay for what lies in the mouth [m].
double reach_in_mouth(const BagModel& m, const BagState& s, const BagWork& w, size_t first, size_t count) noexcept {
  double reach = 0;
  bool some_in = false, some_out = false;
  for (size_t i = first; i < first + count; ++i) {
    some_in = some_in || s.points[i].where == BagPoint::inside;
    some_out = some_out || s.points[i].where == BagPoint::over_mouth;
    if (s.points[i].where == BagPoint::elsewhere || !w.bodies[i].near) continue;
    const AtMouth at = at_mouth(m, s, w.bodies[i].x);
    if (std::fabs(at.height) < std::max(kInMouth, count == 1 ? w.bodies[i].radius : 0.0))
      reach = std::max(reach, at.out + w.bodies[i].radius + kLeavesBag);
  }
  return count == 1 || (some_in && some_out) ? reach : 0;
}

/// Of a rod that goes through the mouth.
double reach_of_rod(const BagModel& m, const BagState& s, const collision::Capsule& rod) noexcept {
  const double a = dot(rod.a - s.middle(m), s.frame.up), b = dot(rod.b - s.middle(m), s.frame.up);
  if (a * b >= 0) return 0;
  const AtMouth at = at_mouth(m, s, rod.a + (a / (a - b)) * (rod.b - rod.a));
  return at.out < m.hoop * s.hoop ? at.out + rod.radius + kLeavesBag : 0;
}

/// Downhill from `start`.
int walk_over_cloth(const BagModel& m, const BagState& s, int start, Vec3d p) noexcept {
  int here = start;
  double best = geometry::distance2(s.x[size_t(here)], p);
  for (int step = 0; step < 64; ++step) {
    const int from = here;
    for (std::int32_t k = m.neighbour_first[size_t(from)]; k < m.neighbour_first[size_t(from) + 1]; ++k) {
      const int n = m.neighbour[size_t(k)];
      const double d = geometry::distance2(s.x[size_t(n)], p);
      if (d < best) best = d, here = n;
    }
    if (here == from) break;
  }
  return here;
}

int nearest_of_all(const BagState& s, Vec3d p) noexcept {
  size_t best = 0;
  double least = 1e30;
  for (size_t n = 0; n < s.x.size(); ++n)
    if (const double d = geometry::distance2(s.x[n], p); d < least) least = d, best = n;
  return int(best);
}

void touch_hoop(const BagModel& m, const BagState& s, std::int32_t point, BagWork& w) noexcept {
  const BagBody& body = w.bodies[size_t(point)];
  const Vec3d off = body.x - s.middle(m);
  const double height = dot(off, s.frame.up), reach = body.radius + kBandThick + kTouchAhead;
  if (std::fabs(height) > reach) return;
  const Vec3d across = off - height * s.frame.up;
  const double out = length(across);
  if (std::fabs(out - s.hoop * m.hoop) > reach || !(out > 1e-6)) return;
  BagTouch t;
  t.point = point;
  t.hoop = s.middle(m) + (s.hoop * m.hoop / out) * across;
  const Vec3d from = body.x - t.hoop;
  const double away = length(from);
  if (away > reach || !(away > 1e-6) || w.touches.size() == w.touches.capacity()) return;
  t.normal = from / away;
  t.away = body.radius + kBandThick;
  w.touches.push_back(t);
}

double lost_at(const BagPoint& p) noexcept { return p.where == BagPoint::inside ? kStillIn : kAnotherSide; }

/// So far from the nearest node that none of its triangles is near, on its own side of it, or altogether lost.
bool is_clear(const BagState& s, const BagWork& w, const BagPoint& p, const BagBody& body) noexcept {
  constexpr double kTriangles = 0.014, kBulges = 0.008;  // [m] how far triangles reach; rise above a node's plane
  const Vec3d off = body.x - s.x[size_t(p.node)];
  const double away2 = dot(off, off), far = kTriangles + body.radius, lost = lost_at(p) + body.radius;
  if (away2 > lost * lost) return true;
  const double outwards = dot(off, w.normal[size_t(p.node)]);
  const double above = p.where == BagPoint::inside ? -outwards : outwards;  // on its own side
  return above > 0 && (away2 > far * far || above > kBulges + body.radius);
}

/// The place of the cloth next to a point, on the triangles at its nearest node.
struct OnCloth {
  geometry::TrianglePoint<double> at{{}, {}, 1e30};
  std::int32_t face = 0;
};
OnCloth nearest_on_cloth(const BagModel& m, const BagState& s, size_t node, Vec3d p) noexcept {
  OnCloth best;
  const auto look = [&](auto&& nearest) {
    for (std::int32_t k = m.face_first[node]; k < m.face_first[node + 1]; ++k) {
      const std::int32_t face = m.face[size_t(k)];
      const auto& t = m.triangles[size_t(face)];
      geometry::TrianglePoint<double> on;
      if (nearest(s.x[size_t(t[0])], s.x[size_t(t[1])], s.x[size_t(t[2])], on) && on.distance2 < best.at.distance2)
        best = {on, face};
    }
  };
  look([p](Vec3d a, Vec3d b, Vec3d c, auto& on) { return geometry::foot_on_triangle(p, a, b, c, on); });
  if (best.at.distance2 < 1e30) return best;
  look([p](Vec3d a, Vec3d b, Vec3d c, auto& on) { return on = geometry::closest_on_triangle(p, a, b, c), true; });
  return best;
}

void touch_cloth(const BagModel& m, const BagState& s, std::int32_t point, BagWork& w) noexcept {
  const BagBody& body = w.bodies[size_t(point)];
  const OnCloth on = nearest_on_cloth(m, s, size_t(s.points[size_t(point)].node), body.x);
  const geometry::TrianglePoint<double>& best = on.at;
  const size_t face = size_t(on.face);
  const auto& nodes = m.triangles[face];
  Vec3d outwards;
  for (size_t k = 0; k < 3; ++k) outwards += best.weights[int(k)] * w.normal[size_t(nodes[k])];
  const Vec3d own = s.points[size_t(point)].where == BagPoint::inside ? -outwards : outwards;
  const Vec3d off = body.x - best.point;
  const double away = std::sqrt(best.distance2), side = dot(off, own) < 0 ? -1.0 : 1.0;
  const double keep = body.radius + kClothThick;
  if (side * away > keep + kTouchAhead || side * away < -lost_at(s.points[size_t(point)])) return;
  if (w.touches.size() == w.touches.capacity()) return;
  BagTouch t;
  t.point = point;
  t.nodes = nodes;
  t.weights = best.weights;
  t.normal = away > 1e-6 ? (side / away) * off : normalised(own, s.frame.up);
  t.away = keep;
  w.touches.push_back(t);
}

}  // namespace

namespace {

/// What has come in over the rim with the rest of a pouch, and not through the mouth's plane: it lies in the sack.
void take_along(const BagModel& m, const BagPouch& p, Vec3d down, BagState& s, const BagWork& w) noexcept {
  constexpr double kRest = 0.33;  // share of it that has to be inside: our estimate
  const auto first = s.points.begin() + p.first, last = first + p.count;
  const auto inside = [](const BagPoint& q) { return q.where == BagPoint::inside; };
  if (double(std::count_if(first, last, inside)) < kRest * p.count || s.shut()) return;
  for (size_t i = size_t(p.first); i < size_t(p.first + p.count); ++i) {
    if (s.points[i].where != BagPoint::elsewhere || !w.bodies[i].near) continue;
    const Vec3d off = w.bodies[i].x - s.middle(m);
    const double below = dot(off, down);
    if (below > 0 && length(off - below * down) < reach_inside(m, s, below) + kPouchBack)
      s.points[i].where = BagPoint::inside;
  }
}

}  // namespace

void note_places(const BagModel& m, Vec3d down, BagState& s, BagWork& w) noexcept {
  const double radius = m.hoop * s.hoop;
  for (size_t i = 0; i < s.points.size(); ++i) {
    BagPoint& p = s.points[i];
    BagPoint::Where now = BagPoint::elsewhere;
    if (w.bodies[i].near)
      now = where_now(s, radius, i < size_t(m.rigids) ? kBack : kPouchBack, BagPoint::Where(p.where),
                      at_mouth(m, s, w.bodies[i].x));
    p.where = now;
  }
  for (const BagPouch& p : m.pouches) take_along(m, p, down, s, w);
  double reach = 0;
  for (size_t i = 0; i < size_t(m.rigids); ++i) reach = std::max(reach, reach_in_mouth(m, s, w, i, 1));
  for (const BagPouch& p : m.pouches)
    reach = std::max(reach, reach_in_mouth(m, s, w, size_t(p.first), size_t(p.count)));
  for (const BagRod& rod : w.rods) reach = std::max(reach, reach_of_rod(m, s, rod.now));
  w.narrowest = reach / m.hoop;
}

void find_touches(const BagModel& m, std::uint64_t tick, BagState& s, BagWork& w) noexcept {
  for (size_t i = 0; i < s.points.size(); ++i) {
    const BagBody& body = w.bodies[i];
    if (!body.near) continue;
    BagPoint& p = s.points[i];
    touch_hoop(m, s, std::int32_t(i), w);
    const bool looks = (tick + i) % kLooks == 0;
    p.node = std::int16_t(looks ? nearest_of_all(s, body.x) : walk_over_cloth(m, s, p.node, body.x));
    if (p.where == BagPoint::over_mouth || is_clear(s, w, p, body)) continue;
    touch_cloth(m, s, std::int32_t(i), w);
  }
}

namespace {

void push(int node, Vec3d normal, double depth, const BagBody& body, Vec3d drift, NetworkLoads& loads) noexcept {
  const double counts = std::min(depth, kDeepestPush);
  tissue::NodeLoad load;
  load.node = node;
  load.k = float(kPouchStiffness);
  load.d = float(kPouchDamping);
  load.dir = vec_cast<float>(normal);
  load.x0 = vec_cast<float>(body.x + counts * normal);
  load.f0 = vec_cast<float>(kPouchDamping * dot(drift, normal) * normal);
  loads.add(load, {Owner::body, 0, 0});
  const Vec3d slip = body.speed - drift, across = slip - dot(slip, normal) * normal;
  tissue::NodeLoad rub;
  rub.node = node;
  rub.d = float(kRubs * kPouchStiffness * counts / std::max(length(across), kCreeps));
  rub.f0 = vec_cast<float>(double(rub.d) * drift);
  loads.add(rub, {Owner::body, 0, 0});
}

}  // namespace

Vec3d drift_of(const BagModel& m, const BagState& s) noexcept {
  Vec3d sum;
  for (size_t n = size_t(m.around); n < s.v.size(); ++n) sum += s.v[n];
  return (1.0 / double(std::max<size_t>(1, s.v.size() - size_t(m.around)))) * sum;
}

void push_off_hoop(const BagTouch& t, const BagBody& body, int node, NetworkLoads& loads) noexcept {
  const double depth = t.away - dot(body.x - t.hoop, t.normal);
  if (t.nodes[0] < 0 && depth > 0) push(node, t.normal, depth, body, {}, loads);
}

void keep_in_bag(const BagModel& m, const BagState& s, Vec3d down, const BagBody& body, int node, Vec3d drift,
                 NetworkLoads& loads) noexcept {
  const Vec3d off = body.x - s.middle(m);
  const double below = dot(off, down), reach = reach_inside(m, s, below);
  const Vec3d across = off - below * down;
  const double out = length(across);
  if (reach < 0) return push(node, -down, below - m.deep + body.radius, body, drift, loads);
  const double depth = out + body.radius - reach;
  if (!(depth > 0) || !(out > 1e-6)) return;
  // outwards on the sack's wall, from how its girth changes
  constexpr double kStep = 0.001;  // [m]
  const double narrows = (reach - std::max(0.0, reach_inside(m, s, below + kStep))) / kStep;
  push(node, -normalised((1 / out) * across + narrows * down), depth / std::sqrt(1 + narrows * narrows), body, drift,
       loads);
}

BagShare share_in(const BagModel& m, const BagState& s, BodyId body) noexcept {
  const auto inside = [&s](size_t i) { return int(s.points[i].where == BagPoint::inside); };
  if (body.is(BodyKind::rigid) && body.index() < size_t(m.rigids)) return {inside(body.index()), 1};
  BagShare share;
  for (const BagPouch& p : m.pouches) {
    if (!body.is(BodyKind::membrane) || body.index() != size_t(p.membrane)) continue;
    share.all = p.count;
    for (size_t i = size_t(p.first); i < size_t(p.first + p.count); ++i) share.inside += inside(i);
  }
  return share;
}

}  // namespace trocar::interactions
