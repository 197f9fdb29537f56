#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/kinematics/fulcrum.hpp>
#include <trocar/kinematics/loops/conditions.hpp>
#include <trocar/studies/halton.hpp>
#include <trocar/studies/operating_room/room_model.hpp>

namespace trocar::studies {

using namespace kinematics;

namespace {

constexpr int kAttempts = 12;  // of inverse kinematics: a motion continues from where it stood
constexpr int kGoalRows = 6;
constexpr double kBesidePort = 0.08;              // of a shaft: nearer to its port it is by the skin anyway [m]
constexpr double kColumn = 0.045, kBeam = 0.040;  // radii of stands [m]
constexpr double kGravity = 9.81;
constexpr double kStraight = 1e-9;        // jaws along the shaft [rad]
constexpr double kNearlyStraight = 1e-3;  // a wrist that continues to be so [rad]

Vec3d unit(Vec3d v) { return v / length(v); }

/// The body that a body hangs on is one of `marked`, or it is itself.
std::vector<unsigned char> behind(const Mechanism& m, int body, bool itself) {
  std::vector<unsigned char> out(m.bodies.size(), 0);
  if (itself) out[std::size_t(body)] = 1;
  for (std::size_t k = std::size_t(body) + 1; k < m.bodies.size(); ++k) {
    const int parent = m.bodies[k].parent;
    if (parent == body || (parent >= 0 && out[std::size_t(parent)])) out[k] = 1;
  }
  return out;
}

/// Independent coordinates that move nothing but marked bodies.
std::vector<int> movers_of(const Mechanism& m, const std::vector<unsigned char>& marked) {
  std::vector<unsigned char> other(std::size_t(m.u_count()), 0), some(std::size_t(m.u_count()), 0);
  for (std::size_t b = 0; b < m.bodies.size(); ++b) {
    const int q = m.bodies[b].coordinate;
    if (q < 0) continue;
    for (int e = m.expand_start[std::size_t(q)]; e < m.expand_start[std::size_t(q) + 1]; ++e)
      (marked[b] ? some : other)[std::size_t(m.expand[std::size_t(e)].u)] = 1;
  }
  std::vector<int> out;
  for (int u = 0; u < m.u_count(); ++u)
    if (!other[std::size_t(u)]) out.push_back(u);  // also what moves nothing at all
  return out;
}

PlacedShape rod(Vec3d a, Vec3d b, double radius) { return {false, a, b, radius, Mat3d::identity()}; }

/// A box as a rod about its longest axis that holds it.
PlacedShape as_rod(const PlacedShape& s) {
  if (!s.box) return s;
  int longest = 0;
  for (int k = 1; k < 3; ++k)
    if (s.b[k] > s.b[longest]) longest = k;
  const double i = s.b[(longest + 1) % 3], j = s.b[(longest + 2) % 3], radius = std::sqrt(i * i + j * j);
  const double half = std::max(0.0, s.b[longest] - radius);
  return rod(s.a - half * s.axes.column(longest), s.a + half * s.axes.column(longest), radius);
}

/// The place of a shape's middle line, or of a box, that is nearest to p.
Vec3d nearest_in(const PlacedShape& s, Vec3d p) {
  if (s.box) {
    const Vec3d q = transposed(s.axes) * (p - s.a);
    return s.a + s.axes * Vec3d{std::clamp(q.x, -s.b.x, s.b.x), std::clamp(q.y, -s.b.y, s.b.y),
                                std::clamp(q.z, -s.b.z, s.b.z)};
  }
  const Vec3d way = s.b - s.a;
  const double whole = dot(way, way);
  return s.a + (whole > 0 ? std::clamp(dot(p - s.a, way) / whole, 0.0, 1.0) : 0) * way;
}

/// Where two things are nearest: looked for along the first in turns [projections onto each other].
void find_place(Near& n, const PlacedShape& first, const PlacedShape& second) {
  n.from = nearest_in(first, second.box ? second.a : 0.5 * (second.a + second.b));
  for (int round = 0; round < 30; ++round) {
    n.to = nearest_in(second, n.from);
    n.from = nearest_in(first, n.to);
  }
}

/// The same on a figure: along a rod, then against the slope of the distance.
void find_place(Near& n, const PlacedShape& rod, const geometry::Figure& figure) {
  constexpr int kPlaces = 24;
  constexpr double kStep = 1e-4;
  double least = 1e9;
  for (int k = 0; k <= kPlaces; ++k) {
    const Vec3d p = rod.a + (double(k) / kPlaces) * (rod.b - rod.a);
    if (const double d = figure.distance(p); d < least) least = d, n.from = p;
  }
  Vec3d slope;
  for (int k = 0; k < 3; ++k) {
    Vec3d a = n.from, b = n.from;
    a[k] += kStep, b[k] -= kStep;
    slope[k] = figure.distance(a) - figure.distance(b);
  }
  n.to = length(slope) > 0 ? n.from - least / length(slope) * slope : n.from;
}

/// Shoulder, elbow, hand: the elbow lower and outwards.
Vec3d elbow_between(Vec3d shoulder, Vec3d hand, double upper, double fore, Vec3d out) {
  const Vec3d way = hand - shoulder;
  const double d = std::min(length(way), 0.999 * (upper + fore));
  const Vec3d along = length(way) > 1e-9 ? unit(way) : Vec3d{0, 0, -1};
  const double a = (d * d + upper * upper - fore * fore) / (2 * d);
  const double high = std::sqrt(std::max(0.0, upper * upper - a * a));
  Vec3d side = Vec3d{0, 0, -1} + 0.6 * out;
  side = side - dot(side, along) * along;
  return shoulder + a * along + high * (length(side) > 1e-9 ? unit(side) : out);
}

}  // namespace

Mat3d jaw_axes(Vec3d towards, double roll) noexcept {
  const FulcrumPose p = inverse(Vec3d{}, towards, roll);
  return forward(Vec3d{}, p).rotation;
}

double port_gap(const Frame& shaft, Vec3d port) noexcept {
  const Vec3d axis = shaft.r.column(2), way = port - shaft.p;
  return length(way - dot(way, axis) * axis);
}

PlacedShape moved(const Frame& by, PlacedShape shape) noexcept {
  shape.a = by * shape.a;
  if (shape.box)
    shape.axes = by.r * shape.axes;
  else
    shape.b = by * shape.b;
  return shape;
}

RoomModel::RoomModel(scene::Room room) : m_room(std::move(room)), m_figure(m_room.patient) {
  for (const scene::RoomArm& a : m_room.arms) build_arm(a);
}

void RoomModel::build_arm(const scene::RoomArm& described) {
  ArmModel a;
  a.described = &described;
  a.mechanism = build(described.mechanism);
  const Mechanism& m = a.mechanism;
  a.tip = m.frame(described.tip);
  a.shaft = m.frame(described.shaft);
  const int port = m_room.port(described.port);
  if (a.tip < 0 || a.shaft < 0 || port < 0)
    throw std::invalid_argument(tr("arm \"{}\" lacks its tip, its shaft or its port", described.name));
  a.port = m_room.ports[std::size_t(port)].position;
  const Vec3d out = length(described.out) > 0 ? unit(described.out) : m_figure.normal(a.port.x, a.port.y);
  const Vec3d towards = described.base - dot(described.base, out) * out;
  if (!(length(towards) > 1e-9)) throw std::invalid_argument(tr("arm \"{}\" stands along its shaft", described.name));
  // the base may be lower or higher than square to the shaft: the shaft's middle then leans
  const Vec3d y = unit(described.base), x = unit(cross(y, out)), z = cross(x, y);
  a.dock = {Mat3d::from_columns(x, y, z), a.port};
  if (const int base = m.frame("base"); base >= 0) {
    Pose pose(m);
    forward(m, m.start_u(), pose);
    a.hub = kinematics::place(m.frames[std::size_t(base)], pose).p;
  }
  const int shaft_body = m.frames[std::size_t(a.shaft)].body, tip_body = m.frames[std::size_t(a.tip)].body;
  a.inner = behind(m, shaft_body, false);
  a.wrist = movers_of(m, a.inner);
  std::vector<unsigned char> beside = a.inner;  // behind the shaft, and not on the way to the tip
  for (int b = tip_body; b > shaft_body; b = m.bodies[std::size_t(b)].parent) beside[std::size_t(b)] = 0;
  a.jaws = movers_of(m, beside);
  a.body_link.assign(m.bodies.size(), 0);
  for (std::size_t l = 0; l < m.link_body.size(); ++l) a.body_link[std::size_t(m.link_body[l])] = int(l);
  LoopWork work(m);
  std::vector<double> u = m.start_u();
  if (!close(m, u, work).closed())
    throw std::invalid_argument(tr("arm \"{}\": its mechanism's loops do not close", described.name));
  const Frame tip = kinematics::place(m.frames[std::size_t(a.tip)], work.pose);
  const Vec3d along = a.dock.r * unit(tip.p);
  a.straight = transposed(jaw_axes(along, 0)) * (a.dock.r * tip.r);
  m_arms.push_back(std::move(a));
}

int RoomModel::arm(const std::string& name) const {
  for (std::size_t k = 0; k < m_arms.size(); ++k)
    if (m_arms[k].described->name == name) return int(k);
  return -1;
}

Frame RoomModel::table_frame(const scene::RoomTilt& tilt) const noexcept {
  const Mat3d turn = turn_about({0, 1, 0}, tilt.left_down) * turn_about({1, 0, 0}, -tilt.head_down);
  const Vec3d axis{0, 0, top() - m_room.table.drop};
  return {turn, axis - turn * axis};
}

Vec3d RoomModel::gravity(const scene::RoomTilt& tilt) const noexcept {
  return transposed(table_frame(tilt).r) * Vec3d{0, 0, -kGravity};
}

bool RoomModel::can_tilt(const scene::RoomTilt& t) const noexcept {
  constexpr double kSlack = 1e-9;
  const scene::RoomTable& table = m_room.table;
  return t.head_down <= table.head_down_most + kSlack && t.head_down >= -table.head_up_most - kSlack &&
         std::fabs(t.left_down) <= table.side_most + kSlack;
}

RoomPose RoomModel::start() const {
  RoomPose pose;
  pose.tilt = m_room.table.tilt;
  for (const ArmModel& a : m_arms) {
    std::vector<double> u = a.mechanism.start_u();
    LoopWork work(a.mechanism);
    close(a.mechanism, u, work);
    pose.u.push_back(std::move(u));
    pose.frames.push_back(work.pose);
  }
  place(pose);
  return pose;
}

void RoomModel::place(RoomPose& pose) const {
  for (std::size_t k = 0; k < m_arms.size(); ++k) forward(m_arms[k].mechanism, pose.u[k], pose.frames[k]);
}

Frame RoomModel::base(int arm, const scene::RoomTilt& tilt) const noexcept {
  const ArmModel& a = m_arms[std::size_t(arm)];
  if (a.described->on_table) return a.dock;
  return kinematics::inverse(table_frame(tilt)) * (table_frame(m_room.table.tilt) * a.dock);
}

Frame RoomModel::tip(const RoomPose& pose, int arm) const noexcept {
  const ArmModel& a = m_arms[std::size_t(arm)];
  return base(arm, pose.tilt) *
         kinematics::place(a.mechanism.frames[std::size_t(a.tip)], pose.frames[std::size_t(arm)]);
}
Frame RoomModel::shaft(const RoomPose& pose, int arm) const noexcept {
  const ArmModel& a = m_arms[std::size_t(arm)];
  return base(arm, pose.tilt) *
         kinematics::place(a.mechanism.frames[std::size_t(a.shaft)], pose.frames[std::size_t(arm)]);
}

Reached RoomModel::lead(RoomPose& pose, int arm, const ArmGoal& goal) const {
  const ArmModel& a = m_arms[std::size_t(arm)];
  const Mechanism& m = a.mechanism;
  std::vector<double>& u = pose.u[std::size_t(arm)];
  const std::vector<double> before = u;
  const Frame to_arm = kinematics::inverse(base(arm, pose.tilt));
  const Frame wanted = to_arm * Frame{goal.axes * a.straight, goal.tip};
  const Closure closure = reach(m.frames[std::size_t(a.tip)], wanted, goal.aims ? kT | kR : unsigned(kT));
  InverseWork work(m, kGoalRows);
  InverseOptions options;
  options.attempts = kAttempts;
  Reached out;
  InverseReport report;
  const Vec3d along = goal.tip - a.port;
  const std::vector<double> began = m.start_u();
  bool is_straight = true;
  for (const int w : a.wrist)
    is_straight = is_straight && std::fabs(u[std::size_t(w)] - began[std::size_t(w)]) < kNearlyStraight;
  const bool may_be_straight = !goal.aims || (is_straight && length(unit(along) + goal.axes.column(2)) < kStraight);
  if (may_be_straight) {  // the wrist as it began, first
    for (const int w : a.wrist) u[std::size_t(w)] = began[std::size_t(w)];
    hold(work.loops, a.wrist);
    InverseOptions quick = options;
    quick.attempts = 3;
    report = inverse(m, {&closure, 1}, u, work, quick);
    out.straight = report.reached();
  }
  if (!out.straight) {
    u = before;
    hold(work.loops, a.jaws);
    report = inverse(m, {&closure, 1}, u, work, options);
  }
  forward(m, u, pose.frames[std::size_t(arm)]);
  out.within_limits = report.last.limit < 0;
  out.missed = length(tip(pose, arm).p - goal.tip);
  if (report.last.limit >= 0) out.limit = m.coordinates[std::size_t(report.last.limit)];
  out.reached = report.reached();
  if (!out.reached) {  // it stays where it was: the nearest pose may be far from there
    u = before;
    forward(m, u, pose.frames[std::size_t(arm)]);
  }
  std::vector<double> r(std::size_t(std::max(1, m.rows)));
  residuals(m.closures, pose.frames[std::size_t(arm)], r.data());
  int row = 0;
  for (const Closure& c : m.closures)
    for (int k = 0; k < c.count; ++k, ++row)
      if (is_length(c.conditions[std::size_t(k)]))
        out.loop_gap = std::max(out.loop_gap, std::fabs(r[std::size_t(row)]));
  out.port_gap = port_gap(shaft(pose, arm), a.port);
  return out;
}

double RoomModel::clear(RoomPose& pose, int arm, const ArmGoal& goal, int tries) const {
  const ArmModel& a = m_arms[std::size_t(arm)];
  std::vector<RoomPart> others = other_parts(pose);
  for (int k = 0; k < int(m_arms.size()); ++k)
    if (k != arm)
      for (RoomPart& p : arm_parts(pose, k)) others.push_back(std::move(p));
  const auto clearance_now = [&] {
    double least = 1e9;
    for (const Near& n : nearest(pose, arm, others)) least = std::min(least, n.distance);
    return least;
  };
  double best = clearance_now(), stride = 0.15;
  std::vector<double>& u = pose.u[std::size_t(arm)];
  std::vector<double> best_u = u;
  ArmGoal kept = goal;
  for (int k = 0; k < tries; ++k) {  // a step to the side, back onto the goal, and better or not
    u = best_u;
    for (std::size_t i = 0; i < u.size(); ++i)
      u[i] += stride * (2 * halton(k + 1, int(i)) - 1) * a.mechanism.scale(int(i));
    if (goal.aims) {
      if (!lead(pose, arm, kept).reached) continue;
    } else {  // freely: lead() would set the wrist back
      const Closure closure = reach(a.mechanism.frames[std::size_t(a.tip)],
                                    kinematics::inverse(base(arm, pose.tilt)) * Frame{{}, goal.tip}, kT);
      InverseWork work(a.mechanism, kGoalRows);
      hold(work.loops, a.jaws);
      InverseOptions options;
      options.attempts = 1;
      if (!inverse(a.mechanism, {&closure, 1}, u, work, options).reached()) continue;
      forward(a.mechanism, u, pose.frames[std::size_t(arm)]);
    }
    const double now = clearance_now();
    if (now > best) {
      best = now;
      best_u = u;
    } else if (k % 8 == 7) {
      stride *= 0.6;
    }
  }
  u = best_u;
  forward(a.mechanism, u, pose.frames[std::size_t(arm)]);
  return best;
}

RoomModel::Stand RoomModel::stand_of(const ArmModel& a) const noexcept {
  const Frame room = a.described->on_table ? Frame{} : table_frame(m_room.table.tilt);
  Stand s;
  s.hub = room * (a.dock * a.hub);
  s.foot = {a.described->x, a.described->y, a.described->on_table ? top() - 0.05 : floor()};
  s.head = {s.foot.x, s.foot.y, std::max(s.hub.z, s.foot.z + 0.1)};
  return s;
}

double RoomModel::beyond_set_up(int arm) const noexcept {
  const ArmModel& a = m_arms[std::size_t(arm)];
  const Stand s = stand_of(a);
  return length(s.hub - s.head) - a.described->set_up;
}

std::vector<RoomPart> RoomModel::arm_parts(const RoomPose& pose, int arm) const {
  const ArmModel& a = m_arms[std::size_t(arm)];
  const Frame fixed = base(arm, pose.tilt);
  std::vector<RoomPart> parts;
  const int shaft_body = a.mechanism.frames[std::size_t(a.shaft)].body;
  for (const BodyShape& s : a.mechanism.shapes) {
    RoomPart p;
    p.shape = moved(fixed, placed(s, pose.frames[std::size_t(arm)]));
    p.arm = arm;
    p.link = a.body_link[std::size_t(s.body)];
    p.name = fmt::format("{}: {}", a.described->name, a.mechanism.links[std::size_t(p.link)]);
    p.shaft = s.body == shaft_body && !p.shape.box && s.kind == ShapeKind::cylinder;
    p.stand = false;
    if (a.inner[std::size_t(s.body)]) p.link = -2 - p.link;  // in the body
    parts.push_back(std::move(p));
  }
  // its stand: a column, and a beam to its base; on the floor it stays there, on the table it tilts
  const Stand stand = stand_of(a);
  const Vec3d &foot = stand.foot, &head = stand.head, &hub = stand.hub;
  const Frame back = a.described->on_table ? Frame{} : kinematics::inverse(table_frame(pose.tilt));
  for (const auto& [from, to, radius] : {std::tuple(foot, head, kColumn), std::tuple(head, hub, kBeam)}) {
    RoomPart p;
    p.shape = moved(back, rod(from, to, radius));
    p.arm = arm;
    p.stand = true;
    p.name = fmt::format("{}: stand", a.described->name);
    parts.push_back(std::move(p));
  }
  return parts;
}

Vec3d RoomModel::tip_of(const RoomPose& pose, int instrument) const noexcept {
  const auto k = std::size_t(instrument);
  return k < pose.tips.size() ? pose.tips[k] : m_room.instruments[k].tip;
}

Vec3d RoomModel::handle(const RoomPose& pose, int instrument) const noexcept {
  const scene::RoomInstrument& i = m_room.instruments[std::size_t(instrument)];
  const Vec3d port = m_room.ports[std::size_t(m_room.port(i.port))].position, tip = tip_of(pose, instrument);
  return length(port - tip) > 1e-6 ? tip + i.length * unit(port - tip) : tip + Vec3d{0, 0, i.length};
}

PlacedShape RoomModel::screen(const scene::RoomMonitor& m) const noexcept {
  const Vec3d to = Vec3d{0, 0, 0.35} - m.at_place;
  const Vec3d y = unit({to.x, to.y, 0.35 * to.z}), x = unit(cross({0, 0, 1}, y)), z = cross(x, y);
  return {true, m.at_place, {0.436 * m.diagonal, 0.02, 0.245 * m.diagonal}, 0, Mat3d::from_columns(x, y, z)};
}

RoomModel::Body RoomModel::person(int index, const RoomPose& pose) const {
  const scene::RoomPerson& p = m_room.staff[std::size_t(index)];
  const Frame table = table_frame(pose.tilt);
  std::vector<Vec3d> held;
  for (std::size_t i = 0; i < m_room.instruments.size(); ++i)
    if (m_room.instruments[i].held_by == p.name) held.push_back(table * handle(pose, int(i)));
  Body b;
  const double h = p.stature, ground = floor() + p.step;
  Vec3d aim = held.empty() ? Vec3d{0, std::clamp(p.y, -0.5, 0.5), 0} : held[0];
  Vec3d to{aim.x - p.x, aim.y - p.y, 0};
  b.facing = length(to) > 0.01 ? unit(to) : Vec3d{0, 1, 0};
  const Vec3d left = cross(Vec3d{0, 0, 1}, b.facing), foot{p.x, p.y, ground};
  const auto at = [&](double forwards, double sideways, double up) {
    return foot + forwards * h * b.facing + sideways * h * left + Vec3d{0, 0, up * h};
  };
  b.limbs.push_back({at(0, 0.045, 0.03), at(0, 0.05, 0.46), 0.045 * h, 0.068 * h});
  b.limbs.push_back({at(0, -0.045, 0.03), at(0, -0.05, 0.46), 0.045 * h, 0.068 * h});
  b.limbs.push_back({at(0, 0, 0.48), at(0, 0, 0.76), 0.092 * h, 0.098 * h});
  b.limbs.push_back({at(0.012, 0, 0.905), at(0.012, 0, 0.945), 0.056 * h, 0.054 * h});
  for (int side = 0; side < 2; ++side) {
    const double sign = side == 0 ? 1 : -1;
    b.shoulder[side] = at(0, sign * 0.105, 0.815);
    b.hand[side] = at(0.165, sign * 0.035, 0.60);
  }
  for (std::size_t k = 0; k < held.size() && k < 2; ++k) {  // the nearer hand takes it
    const int side = k == 0 ? (dot(held[0] - foot, left) >= 0 ? 0 : 1) : (dot(held[0] - foot, left) >= 0 ? 1 : 0);
    b.hand[side] = held[k];
    b.beyond_reach = std::max(b.beyond_reach, length(held[k] - b.shoulder[side]) - p.reach);
  }
  for (int side = 0; side < 2; ++side) {
    const Vec3d out = (side == 0 ? 1.0 : -1.0) * left;
    const Vec3d way = b.hand[side] - b.shoulder[side];
    if (length(way) > p.reach) b.hand[side] = b.shoulder[side] + p.reach * unit(way);
    b.elbow[side] = elbow_between(b.shoulder[side], b.hand[side], 0.49 * p.reach, 0.51 * p.reach, out);
    b.limbs.push_back({b.shoulder[side], b.elbow[side], 0.040 * h, 0.032 * h});
    b.limbs.push_back({b.elbow[side], b.hand[side], 0.030 * h, 0.022 * h});
  }
  return b;
}

std::vector<RoomPart> RoomModel::other_parts(const RoomPose& pose) const {
  std::vector<RoomPart> parts;
  const auto add = [&](const std::string& name, const PlacedShape& shape) {
    RoomPart p;
    p.shape = shape;
    p.name = name;
    parts.push_back(std::move(p));
  };
  const scene::RoomTable& t = m_room.table;
  const double from = m_figure.soles() - 0.04, to = m_figure.crown() + 0.06;
  add("table", {true,
                {0, (from + to) / 2, top() - t.thickness / 2},
                {t.width / 2, (to - from) / 2, t.thickness / 2},
                0,
                Mat3d::identity()});
  for (std::size_t k = 0; k < m_room.instruments.size(); ++k) {
    const scene::RoomInstrument& i = m_room.instruments[k];
    const Vec3d port = m_room.ports[std::size_t(m_room.port(i.port))].position, end = handle(pose, int(k));
    const Vec3d out = unit(end - tip_of(pose, int(k)));
    if (dot(end - port, out) > kBesidePort) add(i.name, rod(port + 0.02 * out, end, i.camera ? 0.02 : 0.012));
  }
  const Frame back = kinematics::inverse(table_frame(pose.tilt));
  for (std::size_t k = 0; k < m_room.staff.size(); ++k)
    for (const geometry::Limb& l : person(int(k), pose).limbs)
      add(m_room.staff[k].name, moved(back, rod(l.a, l.b, std::max(l.radius_a, l.radius_b))));
  for (const scene::RoomMonitor& m : m_room.monitors) add(m.name, moved(back, screen(m)));
  return parts;
}

std::vector<Near> RoomModel::nearest(const RoomPose& pose, int arm, const std::vector<RoomPart>& others) const {
  const ArmModel& a = m_arms[std::size_t(arm)];
  struct Pair {
    std::string about;
    const std::string *first, *second;
    int other = -1;
    double distance = 0;
    PlacedShape mine, its;
  };
  static const std::string kPatient = "patient";
  std::vector<Pair> pairs;
  const auto note = [&](const RoomPart& mine, const std::string& its, int other, double distance,
                        const PlacedShape& a_shape, const PlacedShape& b_shape) {
    const std::string_view about = std::string_view(its).substr(0, its.find(':'));
    for (Pair& p : pairs)
      if (p.about == about) {
        if (distance < p.distance)
          p.first = &mine.name, p.second = &its, p.distance = distance, p.mine = a_shape, p.its = b_shape;
        return;
      }
    pairs.push_back({std::string(about), &mine.name, &its, other, distance, a_shape, b_shape});
  };
  const std::vector<RoomPart> own = arm_parts(pose, arm);
  for (const RoomPart& p : own) {
    if (p.link < -1) continue;  // in the body
    PlacedShape s = p.shape;
    if (p.shaft) {  // what is out of the body of it
      Vec3d in = s.a, end = s.b;
      if (length(in - a.port) > length(end - a.port)) std::swap(in, end);
      const Vec3d axis = end - a.port;
      if (length(axis) < kBesidePort + 0.005) continue;
      const bool both_out = dot(in - a.port, axis) > 0;
      const Vec3d first = a.port + kBesidePort * unit(axis);
      s.a = both_out && length(in - a.port) > kBesidePort ? in : first;
      s.b = end;
    }
    const PlacedShape thick = as_rod(s);
    if (!(p.stand && a.described->on_table))  // clamped beside the patient during set-up
      note(p, kPatient, -1, m_figure.distance(thick.a, thick.b, thick.radius), thick, {});
    for (const RoomPart& o : others) {
      if (o.arm == arm || o.link < -1) continue;
      if (p.stand && o.name == "table") continue;
      if (o.shaft) continue;  // two shafts out of the body are as near as their carriages are
      note(p, o.name, o.arm, clearance(s, o.shape), s, o.shape);
    }
  }
  std::vector<Near> out;
  for (const Pair& p : pairs) {
    Near n{*p.first, *p.second, arm, p.other, p.distance, {}, {}};
    if (p.second == &kPatient)
      find_place(n, p.mine, m_figure);
    else
      find_place(n, p.mine, p.its);
    out.push_back(std::move(n));
  }
  std::stable_sort(out.begin(), out.end(), [](const Near& x, const Near& y) { return x.distance < y.distance; });
  return out;
}

std::vector<Near> RoomModel::nearest(const RoomPose& pose) const {
  std::vector<Near> all;
  const std::vector<RoomPart> others = other_parts(pose);
  for (int k = 0; k < int(m_arms.size()); ++k) {
    std::vector<RoomPart> with = others;
    for (int o = k + 1; o < int(m_arms.size()); ++o)
      for (RoomPart& p : arm_parts(pose, o)) with.push_back(std::move(p));
    for (Near& n : nearest(pose, k, with)) all.push_back(std::move(n));
  }
  std::stable_sort(all.begin(), all.end(), [](const Near& x, const Near& y) { return x.distance < y.distance; });
  return all;
}

}  // namespace trocar::studies
