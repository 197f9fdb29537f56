// One tick of a thread: as many linear solves as the motion of what holds it asks for, each one step of implicit Euler.
#include <algorithm>
#include <cmath>

#include <trocar/suture/thread/chain.hpp>
#include <trocar/suture/thread/contacts.hpp>
#include <trocar/suture/thread/spin.hpp>
#include <trocar/suture/thread/thread.hpp>

namespace trocar::suture {
namespace {

constexpr double kFreeMotion = 0.2;   ///< that a solve is asked to follow where nothing touches, in spacings
constexpr double kMostMotion = 0.5;   ///< and at the very most, in diameters
constexpr double kForgotten = 0.02;   ///< share of a tick that is not worth another solve
constexpr double kMostSpeed = 3;      ///< that a node is taken to have [m/s]
constexpr double kGripStiffness = 10;  ///< of a hold, in stiffnesses of an element's stretch

double hold_stiffness(const ThreadModel& m) { return kGripStiffness * m.stuff.stretch / m.spacing; }
double turn_stiffness(const ThreadModel& m) {  // of a hold's direction
  return 50 * m.stuff.bend / (m.spacing * m.spacing * m.spacing);
}

/// What a tick has been given, and how far it has come.
struct Tick {
  const ThreadModel& m;
  const ThreadDrive& drive;
  ThreadState& s;
  ThreadWork& w;
  int solves = 0;   ///< before this one
  double left = 1;  ///< share of the tick that is left
  double h = 0;     ///< time of this solve [s]
  double part = 0;  ///< share of what is left that this solve takes
  int near = 0, self = 0, touching = 0;
  double reach = 0;  ///< that the near pairs were found with
  double moved = 0;  ///< by a node since then, at most
  bool full = false;

  bool holds(int k) const { return s.holds[k].active != 0; }
};

// ---- What comes in ----------------------------------------------------------------------------------------------

bool all_finite(const ThreadDrive& d) {
  double sum = 0;
  const auto add = [&sum](Vec3d a) { sum += std::fabs(a.x) + std::fabs(a.y) + std::fabs(a.z); };
  for (const Hold& h : d.holds) add(h.x), add(h.direction), add(h.side), sum += std::fabs(h.friction_limit);
  for (const Obstacle& o : d.obstacles)
    if (o.present) add(o.a), add(o.b), sum += std::fabs(o.radius) + std::fabs(o.friction);
  for (const SkinContact& c : d.skins)
    if (c.node >= 0) add(c.point), add(c.normal), add(c.velocity), sum += std::fabs(c.stiffness + c.friction);
  for (const Passage& p : d.passages)
    add(p.x), add(p.in), add(p.out), sum += std::fabs(p.stiffness) + std::fabs(p.drag) + std::fabs(p.friction);
  return sum < 1e9;
}

bool is_zero(Vec3d a) { return a.x == 0 && a.y == 0 && a.z == 0; }

Vec3d direction_of(const ThreadState& s, int e) { return normalised(s.x[e + 1] - s.x[e]); }

/// A slot that begins sees its holder where the thread is.
void begin_slots(Tick& t) {
  for (int k = 0; k < t.m.holds; ++k) {
    HoldState& h = t.s.holds[k];
    if (!h.active || !h.fresh) continue;
    h.fresh = 0;
    const int e = place_at(t.m, h.s).element;
    h.seen = point_at(t.m, t.s, h.s);
    h.aim = direction_of(t.s, e);
    h.side = t.s.director[e];
    h.material = {0, 1, 0};
    if (k < int(t.drive.holds.size()) && !is_zero(t.drive.holds[k].side)) {
      h.side = normalised(t.drive.holds[k].side - dot(t.drive.holds[k].side, h.aim) * h.aim, h.side);
      h.material = {0, dot(t.s.director[e], h.side), dot(t.s.director[e], cross(h.aim, h.side))};
    }
  }
  for (int k = 0; k < t.m.passages; ++k) {
    PassageState& p = t.s.passages[k];
    if (p.active && p.fresh) p.fresh = 0, p.seen = point_at(t.m, t.s, p.s);
  }
  for (int o = 0; o < t.m.obstacles; ++o) {
    ObstacleState& seen = t.s.obstacles[o];
    const bool present = o < int(t.drive.obstacles.size()) && t.drive.obstacles[o].present;
    if (present && !seen.active) seen = {1, t.drive.obstacles[o].a, t.drive.obstacles[o].b};
    if (!present) seen = {};
  }
}

/// How far what leads the thread has still to go in this tick [m].
double motion_left(const Tick& t) {
  double most = 0;
  for (int k = 0; k < std::min(t.m.holds, int(t.drive.holds.size())); ++k)
    if (t.holds(k)) most = std::max(most, length(t.drive.holds[k].x - t.s.holds[k].seen));
  for (int o = 0; o < std::min(t.m.obstacles, int(t.drive.obstacles.size())); ++o)
    if (t.s.obstacles[o].active)
      most = std::max({most, length(t.drive.obstacles[o].a - t.s.obstacles[o].a),
                       length(t.drive.obstacles[o].b - t.s.obstacles[o].b)});
  for (int k = 0; k < std::min(t.m.passages, int(t.drive.passages.size())); ++k)
    if (t.s.passages[k].active) most = std::max(most, length(t.drive.passages[k].x - t.s.passages[k].seen));
  return most;
}

/// Where a hold is when this solve ends, if all of it is taken.
Vec3d hold_target(const Tick& t, int k) {
  const HoldState& h = t.s.holds[k];
  return k < int(t.drive.holds.size()) ? h.seen + t.part * (t.drive.holds[k].x - h.seen) : h.seen;
}
Vec3d aim_target(const Tick& t, int k, double share) {
  const HoldState& h = t.s.holds[k];
  return normalised(h.aim + share * (t.drive.holds[k].direction - h.aim), h.aim);
}
Vec3d passage_target(const Tick& t, int k) {
  const PassageState& p = t.s.passages[k];
  return k < int(t.drive.passages.size()) ? p.seen + t.part * (t.drive.passages[k].x - p.seen) : p.seen;
}

// ---- Terms of the equations -------------------------------------------------------------------------------------

void add_inertia(Tick& t) {
  const double mass = t.m.stuff.mass * t.m.spacing;
  for (int i = 0; i < t.m.nodes; ++i) {
    const double own = (i == 0 || i + 1 == t.m.nodes ? 0.5 : 1) * mass;
    t.w.system.add(i, i, 1, in_all_ways(own * (1 / (t.h * t.h) + t.m.drag / t.h)));
    t.w.system.push(i, own * (t.s.v[i] / t.h + t.m.gravity));
  }
}

void add_stretch(Tick& t) {
  for (int e = 0; e + 1 < t.m.nodes; ++e) {
    if (!t.s.alive[e]) continue;
    const Vec3d d = t.s.x[e + 1] - t.s.x[e];
    const double r = length(d), l = t.m.spacing, pull = t.m.stuff.stretch * (r / l - 1);
    const Vec3d n = r > 1e-30 ? d / r : Vec3d{1, 0, 0};
    const Symmetric k = along_and_across(t.m.stuff.stretch / l, pull > 0 ? pull / r : 0, n);
    t.w.system.add(e, e, 1, k), t.w.system.add(e + 1, e + 1, 1, k), t.w.system.add(e + 1, e, -1, k);
    t.w.system.push(e, pull * n);
    t.w.system.push(e + 1, -pull * n);
  }
}

bool bends(const ThreadState& s, int i) { return s.alive[i - 1] && s.alive[i]; }

/// The chain's direction at an inner node, and the material's director there.
struct NodeFrame {
  Vec3d t, d;
};
NodeFrame frame_at(const ThreadState& s, int i) {
  const Vec3d before = direction_of(s, i - 1), after = direction_of(s, i);
  const Vec3d t = normalised(before + after, after);
  return {t,
          normalised(carried(before, t, s.director[i - 1]) + carried(after, t, s.director[i]), any_perpendicular(t))};
}
Vec3d bend_error(const Tick& t, int i, const NodeFrame& f) {
  const Vec3d q = (1 / t.m.spacing) * (t.s.x[i - 1] - 2.0 * t.s.x[i] + t.s.x[i + 1]);
  return q - dot(q, f.t) * f.t;
}
Vec3d in_space(const NodeFrame& f, Vec3d bend) { return bend.x * f.d + bend.y * cross(f.t, f.d); }

/// Bends yield: beyond the yield curvature only the moment there is left, and a little more with the bend that stays.
/// The share of the stiffness that a solve keeps is what makes its moment right if it bends as far as the last did.
void add_bending(Tick& t) {
  const double k = t.m.stuff.bend / (t.m.spacing * t.m.spacing * t.m.spacing);
  const double yield = t.m.stuff.yield_curvature * t.m.spacing, c[3] = {1, -2, 1};
  const double harden = t.m.stuff.hardening / (1 - t.m.stuff.hardening);
  for (int i = 1; i + 1 < t.m.nodes; ++i) {
    if (!bends(t.s, i)) continue;
    const NodeFrame f = frame_at(t.s, i);
    const Vec3d rest = in_space(f, t.s.bend[i]);
    const Vec3d error = bend_error(t, i, f) - rest;
    const double share = yield > 0 && t.s.bend[i].z > yield ? yield / t.s.bend[i].z : 1;
    const Vec3d back = harden * rest;  // the part of the moment that hardening has made
    const Vec3d moment = back + share * (error - back);
    const Symmetric stiff = along_and_across(0, k * share, f.t);
    const std::int32_t nodes[3] = {i - 1, i, i + 1};
    t.w.system.add_term(nodes, c, 3, stiff);
    for (int j = 0; j < 3; ++j) t.w.system.push(i - 1 + j, (-k * t.m.spacing * c[j]) * moment);
  }
}

/// What yields stays bent.
void flow(Tick& t) {
  const double yield = t.m.stuff.yield_curvature * t.m.spacing;
  if (!(yield > 0)) return;
  const double harden = t.m.stuff.hardening / (1 - t.m.stuff.hardening);
  for (int i = 1; i + 1 < t.m.nodes; ++i) {
    if (!bends(t.s, i)) continue;
    const NodeFrame f = frame_at(t.s, i);
    const Vec3d rest = in_space(f, t.s.bend[i]);
    const Vec3d over = bend_error(t, i, f) - (1 + harden) * rest;
    const double size = length(over);
    Vec3d& bend = t.s.bend[i];
    bend.z = size;
    if (!(size > yield)) continue;
    const Vec3d more = ((size - yield) / (size * (1 + harden))) * over;
    bend.x += dot(more, f.d);
    bend.y += dot(more, cross(f.t, f.d));
  }
}

void couple_touching(Tick& t) {
  t.w.system.open();
  for (int k = 0; k < t.self; ++k) {
    const Touch& touch = t.w.self[k];
    const std::int32_t nodes[4] = {touch.a, touch.a + 1, touch.b, touch.b + 1};
    t.w.system.couple(nodes, 4);
  }
  for (int k = 0; k < t.m.ties; ++k) {
    const TieState& tie = t.s.ties[k];
    const int a = place_at(t.m, std::min(tie.s, tie.t)).element, b = place_at(t.m, std::max(tie.s, tie.t)).element;
    const std::int32_t nodes[4] = {a, a + 1, b, b + 1};
    if (tie.active && b > a + 1) t.w.system.couple(nodes, 4);
  }
  t.w.system.arrange();
}

void add_self(Tick& t) {
  for (int k = 0; k < t.self; ++k) {
    const Touch& touch = t.w.self[k];
    const std::int32_t nodes[4] = {touch.a, touch.a + 1, touch.b, touch.b + 1};
    const double c[4] = {1 - touch.s, touch.s, touch.t - 1, -touch.t};
    t.w.system.add_term(nodes, c, 4, along_and_across(touch.stiffness, touch.rub_stiffness, touch.normal));
    const Vec3d f = touch.press * touch.normal - touch.rub_stiffness * touch.strain;
    for (int j = 0; j < 4; ++j) t.w.system.push(nodes[j], c[j] * f);
  }
}

void add_obstacles(Tick& t) {
  for (int k = 0; k < t.touching; ++k) {
    const Touch& touch = t.w.touch[k];
    const std::int32_t nodes[2] = {touch.a, touch.a + 1};
    const double c[2] = {1 - touch.s, touch.s};
    const Symmetric stiff = along_and_across(touch.stiffness, touch.rub_stiffness, touch.normal);
    t.w.system.add_term(nodes, c, 2, stiff);
    const Vec3d f = touch.press * touch.normal - touch.rub_stiffness * touch.strain + stiff * touch.moved;
    for (int j = 0; j < 2; ++j) t.w.system.push(nodes[j], c[j] * f);
  }
}

void add_spring(Tick& t, const ThreadPlace& at, const Symmetric& stiff, Vec3d force) {
  const std::int32_t nodes[2] = {at.element, at.element + 1};
  const double c[2] = {1 - at.w, at.w};
  t.w.system.add_term(nodes, c, 2, stiff);
  for (int j = 0; j < 2; ++j) t.w.system.push(nodes[j], c[j] * force);
}

/// Stiffness along the thread of something it slips through beyond `bound` [m of strain].
double slip_stiffness(double stiffness, double bound, double reached) {
  return reached > bound ? stiffness * bound / reached : stiffness;
}

void add_holds(Tick& t) {
  const double k = hold_stiffness(t.m);
  for (int n = 0; n < t.m.holds; ++n) {
    const HoldState& h = t.s.holds[n];
    if (!h.active) continue;
    const ThreadPlace at = place_at(t.m, h.s);
    const Vec3d d = direction_of(t.s, at.element);
    const bool given = n < int(t.drive.holds.size());
    const double limit = given ? t.drive.holds[n].friction_limit : 0;
    const double along = limit > 0 ? slip_stiffness(k, limit / k, h.reached) : k;
    const Symmetric stiff = along_and_across(along, k, d);
    add_spring(t, at, stiff, stiff * (hold_target(t, n) - point_at(t.m, t.s, h.s)));
    if (!given || is_zero(t.drive.holds[n].direction)) continue;
    const Vec3d aim = aim_target(t, n, t.part);
    const double turn = turn_stiffness(t.m);
    const Symmetric across = along_and_across(0, turn, aim);
    const std::int32_t nodes[2] = {at.element, at.element + 1};
    const double c[2] = {-1, 1};
    t.w.system.add_term(nodes, c, 2, across);
    const Vec3d f = -(across * (t.s.x[at.element + 1] - t.s.x[at.element]));
    for (int j = 0; j < 2; ++j) t.w.system.push(nodes[j], c[j] * f);
  }
}

double passage_friction(const Tick& t, const Passage& p) {
  return p.friction < 0 ? t.m.stuff.friction_tissue : p.friction;
}
/// The thread's direction where it goes through: given, or its own.
Vec3d passage_direction(const Tick& t, int k, int element) {
  const Passage& p = t.drive.passages[k];
  return normalised(p.in + p.out, direction_of(t.s, element));
}
double passage_bound(const Tick& t, int k) {
  const Passage& p = t.drive.passages[k];
  return (p.drag + passage_friction(t, p) * t.s.passages[k].press) / p.stiffness;
}

void add_passages(Tick& t) {
  for (int n = 0; n < std::min(t.m.passages, int(t.drive.passages.size())); ++n) {
    const PassageState& p = t.s.passages[n];
    if (!p.active) continue;
    const double k = t.drive.passages[n].stiffness;
    const ThreadPlace at = place_at(t.m, p.s);
    const double along = slip_stiffness(k, passage_bound(t, n), p.reached);
    const Symmetric stiff = along_and_across(along, k, passage_direction(t, n, at.element));
    add_spring(t, at, stiff, stiff * (passage_target(t, n) - point_at(t.m, t.s, p.s)));
  }
}

void add_ties(Tick& t) {
  const double k = t.m.stuff.stretch / t.m.spacing;
  for (int n = 0; n < t.m.ties; ++n) {
    const TieState& tie = t.s.ties[n];
    if (!tie.active) continue;
    const bool turned_round = tie.s > tie.t;
    const ThreadPlace a = place_at(t.m, turned_round ? tie.t : tie.s), b = place_at(t.m, turned_round ? tie.s : tie.t);
    if (b.element <= a.element + 1) continue;
    const std::int32_t nodes[4] = {a.element, a.element + 1, b.element, b.element + 1};
    const double c[4] = {1 - a.w, a.w, b.w - 1, -b.w};
    t.w.system.add_term(nodes, c, 4, in_all_ways(k));
    const Vec3d offset = turned_round ? tie.offset : -tie.offset;  // wanted from b to a
    const Vec3d f = k * (offset - point_at(t.m, t.s, turned_round ? tie.t : tie.s) +
                         point_at(t.m, t.s, turned_round ? tie.s : tie.t));
    for (int j = 0; j < 4; ++j) t.w.system.push(nodes[j], c[j] * f);
  }
}

/// Skins are planes that nodes lie on. What friction does there is found as between elements.
Touch skin_touch(const Tick& t, int k) {
  const SkinContact& c = t.drive.skins[k];
  const Vec3d x = t.s.x[c.node];
  const double gap = dot(x - c.point, c.normal) - 0.5 * t.m.stuff.diameter;
  Touch touch{.a = c.node, .b = k, .normal = c.normal};
  if (gap >= 0.02 * t.m.stuff.diameter) return touch;
  set_press(touch, c.stiffness, t.m.stuff.diameter, gap);
  if (t.s.skins[k].node == c.node) {
    touch.strain = t.s.skins[k].rub.strain - dot(t.s.skins[k].rub.strain, c.normal) * c.normal;
    touch.reached = t.s.skins[k].rub.reached;
  }
  set_friction(touch, c.friction < 0 ? t.m.stuff.friction_tissue : c.friction, 0.5 * c.stiffness);
  touch.moved = t.h * c.velocity;
  return touch;
}
bool skin_given(const Tick& t, int k) {
  const int node = t.drive.skins[k].node;
  return node >= 0 && node < t.m.nodes;
}

void add_skins(Tick& t) {
  for (int k = 0; k < std::min(t.m.skins, int(t.drive.skins.size())); ++k) {
    if (!skin_given(t, k)) continue;
    const Touch touch = skin_touch(t, k);
    if (!(touch.press > 0)) continue;
    const Symmetric stiff = along_and_across(touch.stiffness, touch.rub_stiffness, touch.normal);
    t.w.system.add(touch.a, touch.a, 1, stiff);
    const Vec3d across = touch.moved - dot(touch.moved, touch.normal) * touch.normal;
    t.w.system.push(touch.a, touch.press * touch.normal + touch.rub_stiffness * (across - touch.strain));
  }
}

// ---- What a solve leaves ----------------------------------------------------------------------------------------

/// Friction's strain after a motion: what is beyond its bound has slipped.
void slip(Touch& touch, Vec3d motion) { touch.strain += motion - dot(motion, touch.normal) * touch.normal; }
void settle(Touch& touch) {
  touch.reached = length(touch.strain);
  if (touch.reached > touch.bound) touch.strain *= touch.bound / touch.reached;
}

/// A hold or a passage whose thread has slipped beyond its bound holds another place of it; returns how far.
double slip_along(const Tick& t, Vec3d holder, Vec3d d, double bound, double& s, double& reached) {
  const double along = dot(point_at(t.m, t.s, s) - holder, d);
  reached = std::fabs(along);
  if (!(reached > bound)) return 0;
  const double slipped = along > 0 ? along - bound : along + bound;
  s -= slipped;
  return slipped;
}

void move_nodes(Tick& t, double share) {
  double most = 0;
  for (int i = 0; i < t.m.nodes; ++i) most = std::max(most, dot(t.w.delta[i], t.w.delta[i]));
  t.moved += share * std::sqrt(most);
  Vec3d before = direction_of(t.s, 0), last{};
  for (int i = 0; i < t.m.nodes; ++i) {
    const Vec3d v = (share / t.h) * t.w.delta[i];
    const double speed = length(v);
    t.s.v[i] = speed > kMostSpeed ? (kMostSpeed / speed) * v : v;
    const Vec3d old_next = i + 1 < t.m.nodes ? direction_of(t.s, i) : Vec3d{};
    last = t.s.x[i];
    t.s.x[i] += share * t.w.delta[i];
    if (i > 0) carry_directors(t.m, before, i - 1, t.s);
    before = old_next;
  }
  (void)last;
}

/// What the solve says of a touch: its press, its friction, and what of the motion was taken.
void end_touch(Touch& touch, Vec3d motion, double share) {
  const double apart = dot(motion, touch.normal);
  const Vec3d along = motion - apart * touch.normal;
  const double before = touch.press;
  touch.press = std::max(0.0, before - touch.stiffness * apart);
  touch.force = touch.press * touch.normal - touch.rub_stiffness * (touch.strain + along);
  touch.strain += share * along;
}

void rub_after(Tick& t, double share) {
  for (int k = 0; k < t.self; ++k) {
    Touch& touch = t.w.self[k];
    const Vec3d a = (1 - touch.s) * t.w.delta[touch.a] + touch.s * t.w.delta[touch.a + 1];
    const Vec3d b = (1 - touch.t) * t.w.delta[touch.b] + touch.t * t.w.delta[touch.b + 1];
    end_touch(touch, a - b, share);
  }
  for (int k = 0; k < t.touching; ++k) {
    Touch& touch = t.w.touch[k];
    const Vec3d a = (1 - touch.s) * t.w.delta[touch.a] + touch.s * t.w.delta[touch.a + 1];
    end_touch(touch, a - touch.moved, share);
  }
}

void remember(const Touch* touches, int count, std::vector<ElementRub>& rubs, std::int32_t& kept) {
  kept = count;
  for (int k = 0; k < count; ++k)
    rubs[k] = {touches[k].a, touches[k].b, {touches[k].strain, touches[k].reached}, touches[k].press};
}

/// The element's director as a hold wants it.
Vec3d wanted_director(const HoldState& h) {
  return h.material.x * h.aim + h.material.y * h.side + h.material.z * cross(h.aim, h.side);
}

void spin_after(Tick& t) {
  measure_twist(t.m, t.s);
  SpinHold holds[16];
  int count = 0;
  for (int k = 0; k < std::min(t.m.holds, int(t.drive.holds.size())) && count < 16; ++k)
    if (t.holds(k) && !is_zero(t.drive.holds[k].side))
      holds[count++] = {place_at(t.m, t.s.holds[k].s).element, wanted_director(t.s.holds[k])};
  relax_spin(t.m, {holds, std::size_t(count)}, t.self, t.touching, t.s, t.w);
}

void move_slots(Tick& t, double share, const ThreadReactions& out) {
  const double k = hold_stiffness(t.m);
  for (int n = 0; n < t.m.holds; ++n) {
    HoldState& h = t.s.holds[n];
    if (!h.active || n >= int(t.drive.holds.size())) continue;
    const Hold& hold = t.drive.holds[n];
    h.seen += (share * t.part) * (hold.x - h.seen);
    if (!is_zero(hold.direction)) h.aim = aim_target(t, n, share * t.part);
    if (!is_zero(hold.side)) h.side = normalised(h.side + (share * t.part) * (hold.side - h.side), h.side);
    if (!(hold.friction_limit > 0)) continue;
    const Vec3d d = direction_of(t.s, place_at(t.m, h.s).element);
    const double slipped = slip_along(t, h.seen, d, hold.friction_limit / k, h.s, h.reached);
    if (n < int(out.holds.size())) out.holds[n].slipped += slipped;
    if (!(h.s >= 0 && h.s <= t.m.length)) h = {};
  }
  for (int n = 0; n < std::min(t.m.passages, int(t.drive.passages.size())); ++n) {
    PassageState& p = t.s.passages[n];
    if (!p.active) continue;
    p.seen += (share * t.part) * (t.drive.passages[n].x - p.seen);
    const Vec3d d = passage_direction(t, n, place_at(t.m, p.s).element);
    const Vec3d off = point_at(t.m, t.s, p.s) - p.seen;
    p.press = t.drive.passages[n].stiffness * length(off - dot(off, d) * d);
    const double slipped = slip_along(t, p.seen, d, passage_bound(t, n), p.s, p.reached);
    if (n < int(out.passages.size())) out.passages[n].slipped += slipped;
    if (!(p.s >= 0 && p.s <= t.m.length)) p = {};
  }
  for (int o = 0; o < t.m.obstacles; ++o) {
    t.s.obstacles[o].a += share * t.w.obstacle_moves[2 * o];
    t.s.obstacles[o].b += share * t.w.obstacle_moves[2 * o + 1];
  }
  for (int n = 0; n < t.m.skins; ++n) {
    SkinState& skin = t.s.skins[n];
    if (n >= int(t.drive.skins.size()) || !skin_given(t, n)) {
      skin = {};
      continue;
    }
    Touch touch = skin_touch(t, n);
    if (!(touch.press > 0)) {
      skin = {};
      continue;
    }
    slip(touch, share * (t.w.delta[touch.a] - touch.moved));
    settle(touch);
    skin = {touch.a, {touch.strain, touch.reached}};
  }
}

// ---- A solve, a tick --------------------------------------------------------------------------------------------

/// The share of what is left that the next solve takes.
void choose_part(Tick& t) {
  const double motion = motion_left(t);
  const double wanted = t.s.self_count + t.s.touch_count > 0 ? t.m.solve_motion : kFreeMotion * t.m.spacing;
  const double needed = std::min(motion / (t.m.most_solves - t.solves), kMostMotion * t.m.stuff.diameter);
  const double most = std::max(wanted, needed);
  t.part = motion > most ? most / motion : 1;
  t.h = t.m.tick * t.left * t.part;
  for (int o = 0; o < t.m.obstacles; ++o) {
    const bool given = o < int(t.drive.obstacles.size()) && t.s.obstacles[o].active;
    t.w.obstacle_moves[2 * o] = given ? t.part * (t.drive.obstacles[o].a - t.s.obstacles[o].a) : Vec3d{};
    t.w.obstacle_moves[2 * o + 1] = given ? t.part * (t.drive.obstacles[o].b - t.s.obstacles[o].b) : Vec3d{};
  }
}

/// Near pairs hold as long as no node has gone so far that others may have come near.
void look_around(Tick& t) {
  const double d = t.m.stuff.diameter;
  double speed = 0;
  for (int i = 0; i < t.m.nodes; ++i) speed = std::max(speed, dot(t.s.v[i], t.s.v[i]));
  const double ahead = std::max(0.25 * d, 1.2 * t.h * std::sqrt(speed));
  if (t.reach > 0 && d + 2 * (t.moved + ahead) <= t.reach) return;
  t.reach = 1.4 * d + 2 * ahead;  // below two diameters at rest: neighbours but one are not looked at
  t.near = find_near(t.m, t.s, t.reach, t.w);
  t.moved = 0;
}

/// How much of a solution is taken: no node goes so far that it may have met what is not looked at, and nothing passes
/// through anything.
double share_of_step(Tick& t) {
  double most = 0;
  for (int i = 0; i < t.m.nodes; ++i) most = std::max(most, dot(t.w.delta[i], t.w.delta[i]));
  most = std::sqrt(most);
  if (!(most < 1)) return -1;
  const double room = 0.5 * (t.reach - t.m.stuff.diameter) - t.moved;
  double share = safe_share(t.m, t.s, t.near, t.drive.obstacles, t.w);
  if (share * most > room) share = room / most;
  return share;
}

void find_contacts(Tick& t) {
  t.self = find_touching(t.m, t.s, t.near, t.w, t.full);
  t.touching = find_obstacles(t.m, t.s, t.drive.obstacles, t.w, t.full);
}

bool solve_once(Tick& t, const ThreadReactions& out, ThreadReport& report) {
  choose_part(t);
  look_around(t);
  find_contacts(t);
  couple_touching(t);
  add_inertia(t);
  add_stretch(t);
  add_bending(t);
  push_twist(t.m, t.s, t.w);
  add_self(t);
  add_obstacles(t);
  add_skins(t);
  add_holds(t);
  add_passages(t);
  add_ties(t);
  report.coupled = t.w.system.coupled();
  if (t.w.system.factor() >= 0) return false;
  t.w.system.solve();
  for (int i = 0; i < t.m.nodes; ++i) t.w.delta[i] = t.w.system.unknown(i);
  const double share = share_of_step(t);
  if (!(share >= 0)) return false;
  move_nodes(t, share);
  rub_after(t, share);
  spin_after(t);
  for (int k = 0; k < t.self; ++k) settle(t.w.self[k]);
  for (int k = 0; k < t.touching; ++k) settle(t.w.touch[k]);
  remember(t.w.self.data(), t.self, t.s.self, t.s.self_count);
  remember(t.w.touch.data(), t.touching, t.s.touch, t.s.touch_count);
  flow(t);
  move_slots(t, share, out);
  t.left *= 1 - share * t.part;
  return true;
}

void report_reactions(const Tick& t, const ThreadReactions& out) {
  const double k = hold_stiffness(t.m);
  for (int n = 0; n < std::min(t.m.holds, int(out.holds.size())); ++n) {
    const HoldState& h = t.s.holds[n];
    if (!h.active) continue;
    out.holds[n].force = k * (point_at(t.m, t.s, h.s) - h.seen);
    const ThreadPlace at = place_at(t.m, h.s);
    if (n >= int(t.drive.holds.size()) || is_zero(t.drive.holds[n].direction)) continue;
    const Vec3d d = t.s.x[at.element + 1] - t.s.x[at.element];
    out.holds[n].moment = turn_stiffness(t.m) * cross(h.aim, d) * dot(h.aim, d);
  }
  for (int n = 0; n < std::min({t.m.passages, int(out.passages.size()), int(t.drive.passages.size())}); ++n) {
    const PassageState& p = t.s.passages[n];
    if (!p.active) continue;
    out.passages[n].force = t.drive.passages[n].stiffness * (point_at(t.m, t.s, p.s) - p.seen);
    const int e = place_at(t.m, p.s).element;
    out.passages[n].tension_in = e > 0 ? tension(t.m, t.s, e - 1) : 0;
    out.passages[n].tension_out = e + 2 < t.m.nodes ? tension(t.m, t.s, e + 1) : 0;
  }
  for (int k2 = 0; k2 < t.touching; ++k2) {
    const Touch& touch = t.w.touch[k2];
    if (touch.b >= int(out.obstacles.size())) continue;
    const ObstacleState& seen = t.s.obstacles[touch.b];
    const Vec3d force = -touch.force;
    out.obstacles[touch.b].force += force;
    const Vec3d at = seen.a + touch.t * (seen.b - seen.a) + t.drive.obstacles[touch.b].radius * touch.normal;
    out.obstacles[touch.b].moment += cross(at - seen.a, force);
  }
  for (int n = 0; n < std::min({t.m.skins, int(out.skins.size()), int(t.drive.skins.size())}); ++n) {
    if (!skin_given(t, n)) continue;
    const Touch touch = skin_touch(t, n);
    out.skins[n] = touch.rub_stiffness * touch.strain - touch.press * touch.normal;
  }
}

void clear(const ThreadReactions& out) {
  std::fill(out.holds.begin(), out.holds.end(), HoldReaction{});
  std::fill(out.obstacles.begin(), out.obstacles.end(), ObstacleReaction{});
  std::fill(out.skins.begin(), out.skins.end(), Vec3d{});
  std::fill(out.passages.begin(), out.passages.end(), PassageReaction{});
}

void report_loads(const Tick& t, ThreadReport& report) {
  for (int e = 0; e + 1 < t.m.nodes; ++e) {
    const double pull = tension(t.m, t.s, e);
    if (pull > report.tension) report.tension = pull, report.weakest = (e + 0.5) * t.m.spacing;
  }
  const double bears = t.self > 0 ? t.m.stuff.knotted_break_force : t.m.stuff.break_force;
  if (report.tension > bears) report.flags |= ThreadReport::kOverloaded;
  report.contacts = t.self;
  report.lag = motion_left(t);
  if (report.lag > 0.1 * t.m.stuff.diameter) report.flags |= ThreadReport::kLagging;
  if (t.full) report.flags |= ThreadReport::kFull;
}

}  // namespace

ThreadReport advance(const ThreadModel& m, const ThreadDrive& drive, const ThreadReactions& reactions, ThreadState& s,
                     ThreadWork& w) noexcept {
  ThreadReport report;
  clear(reactions);
  if (!all_finite(drive)) {
    report.flags = ThreadReport::kNonFinite;
    return report;
  }
  Tick t{.m = m, .drive = drive, .s = s, .w = w};
  begin_slots(t);
  for (; t.solves < m.most_solves && t.left > kForgotten; ++t.solves) {
    ++report.solves;
    if (!solve_once(t, reactions, report)) {
      report.flags |= ThreadReport::kIndefinite;
      break;
    }
  }
  report_reactions(t, reactions);
  report_loads(t, report);
  return report;
}

}  // namespace trocar::suture
