// What a tick is given: holds, obstacles, skins, passages; where the thread takes them to be, and what it does to them.
#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/suture/thread/contacts.hpp>
#include <trocar/suture/thread/tick.hpp>

namespace trocar::suture {
namespace {

constexpr double kStill = 1e-9;  ///< what moves less has not moved [m]

double passage_friction(const Tick& t, const Passage& p) {
  return p.friction < 0 ? t.m.stuff.friction_tissue : p.friction;
}

/// What a hold or a passage bears along the thread.
struct Bears {
  double bound = 0;      ///< strain by friction [m]
  double stiffness = 0;  ///< [N/m]
  double half = 0;       ///< width of it and of a clip that comes to it [m]
  double turns = 1;      ///< strain that goes with a slip of one, as the way through it turns meanwhile
};
/// Where the thread has slipped beyond that another place of it is there. A clip that comes to it is a stop, which
/// slides along the thread when its friction on it is overcome. Returns how far the thread has gone.
double slip_along(const Tick& t, Vec3d off, Vec3d d, const Bears& bears, double& s, double& reached) {
  const double along = dot(off, d);
  reached = std::fabs(along);
  if (!(reached > bears.bound)) return 0;
  const double stretched = t.w.length[place_at(t.m, s).element] / t.m.spacing;
  double slipped = (along > 0 ? along - bears.bound : along + bears.bound) / (stretched * bears.turns);
  if (t.s.clip_count > 0) {
    const double way = std::fabs(slipped), free = way_to_clip(t.s, s, -slipped, bears.half);
    const double more = free < way ? std::max(0.0, way - free - kClipHolds / bears.stiffness / stretched) : 0.0;
    slipped = along > 0 ? free + more : -(free + more);
    push_clips(t.s, s, -slipped, bears.half);
  }
  s -= slipped;
  return slipped;
}

/// A point that lies `across` from the thread's curve where this bends sharply: its foot on the curve goes less far.
double turning(const Tick& t, int k, Vec3d across) {
  const SmoothPlace at = smooth_place(t.m, t.s.passages[k].s);
  const Vec3d bend = t.s.x[at.nodes[0]] - 2.0 * t.s.x[at.nodes[1]] + t.s.x[at.nodes[2]];
  return std::max(1.0, 1 + dot(across, bend) / (t.m.spacing * t.m.spacing));
}

/// What hardens below a skin keeps a node that is pulled against it from going in. What is found deeper did not come
/// there by a pull.
void set_skin_press(Touch& touch, const SkinContact& c, double thickness, double gap) {
  const bool deep = c.hardens > 0 && gap < -c.hardens;
  set_press(touch, c.stiffness, thickness, deep ? -c.hardens : gap);
  if (!deep) return;
  touch.stiffness = touch.press / c.hardens;
  touch.press = touch.stiffness * -gap;
}

/// A solve that was not taken in full says how hard the thread would press had it gone all of its way; and what holds
/// it is strained by what is left of that.
void keep_to_what_pulls(const Tick& t, std::span<ObstacleReaction> presses) {
  for (int o = 0; o < std::min(t.m.obstacles, int(presses.size())); ++o) {
    const double force = length(presses[o].force);
    if (!(force > 0)) continue;
    const double most = most_press(t, o);
    if (force > most) presses[o].force *= most / force, presses[o].moment *= most / force;
  }
}

}  // namespace

bool all_finite(const ThreadDrive& d) noexcept {
  double sum = 0;
  const auto add = [&sum](Vec3d a) { sum += std::fabs(a.x) + std::fabs(a.y) + std::fabs(a.z); };
  for (const Hold& h : d.holds) add(h.x), add(h.direction), add(h.side), sum += std::fabs(h.friction_limit);
  for (const Obstacle& o : d.obstacles)
    if (o.present) add(o.a), add(o.b), sum += std::fabs(o.radius) + std::fabs(o.friction);
  for (const SkinContact& c : d.skins)
    if (c.node >= 0) add(c.point), add(c.normal), add(c.velocity), sum += std::fabs(c.stiffness + c.friction);
  for (const Passage& p : d.passages)
    add(p.x), sum += std::fabs(p.stiffness) + std::fabs(p.drag) + std::fabs(p.friction);
  return sum < 1e9;
}

/// A slot that begins sees its holder where the thread is.
void begin_slots(Tick& t) noexcept {
  for (int k = 0; k < t.m.holds; ++k) {
    HoldState& h = t.s.holds[k];
    if (!h.active || !h.fresh) continue;
    h.fresh = 0;
    const int e = place_at(t.m, h.s).element;
    h.seen = point_at(t.m, t.s, h.s);
    h.aim = t.w.along[e];
    h.side = t.s.director[e];
    h.material = {0, 1, 0};
    if (k < int(t.drive.holds.size()) && !is_zero(t.drive.holds[k].side)) {
      h.side = normalised(t.drive.holds[k].side - dot(t.drive.holds[k].side, h.aim) * h.aim, h.side);
      h.material = {0, dot(t.s.director[e], h.side), dot(t.s.director[e], cross(h.aim, h.side))};
    }
  }
  for (int k = 0; k < t.m.passages; ++k) {
    PassageState& p = t.s.passages[k];
    if (p.active && p.fresh) p.fresh = 0, p.seen = smooth_place(t.m, p.s).of(t.s.x);
  }
  for (int o = 0; o < t.m.obstacles; ++o) {
    ObstacleState& seen = t.s.obstacles[o];
    const bool present = o < int(t.drive.obstacles.size()) && t.drive.obstacles[o].present;
    if (present && !seen.active) seen = {1, t.drive.obstacles[o].a, t.drive.obstacles[o].b};
    if (!present) seen = {};
  }
}

/// How far what leads the thread has still to go in this tick [m].
double motion_left(const Tick& t) noexcept {
  double most = 0;
  for (int k = 0; k < std::min(t.m.holds, int(t.drive.holds.size())); ++k)
    if (t.s.holds[k].active) most = std::max(most, length(t.drive.holds[k].x - t.s.holds[k].seen));
  for (int o = 0; o < std::min(t.m.obstacles, int(t.drive.obstacles.size())); ++o)
    if (t.s.obstacles[o].active)
      most = std::max({most, length(t.drive.obstacles[o].a - t.s.obstacles[o].a),
                       length(t.drive.obstacles[o].b - t.s.obstacles[o].b)});
  for (int k = 0; k < std::min(t.m.passages, int(t.drive.passages.size())); ++k)
    if (t.s.passages[k].active) most = std::max(most, length(t.drive.passages[k].x - t.s.passages[k].seen));
  return most;
}

/// Where something lags far behind, an obstacle that has less far to go does not wait for it: thread would lie in it.
void set_obstacle_moves(Tick& t) noexcept {
  for (int o = 0; o < t.m.obstacles; ++o) {
    const bool given = t.given_obstacle(o) && t.s.obstacles[o].active;
    const Vec3d a = given ? t.drive.obstacles[o].a - t.s.obstacles[o].a : Vec3d{};
    const Vec3d b = given ? t.drive.obstacles[o].b - t.s.obstacles[o].b : Vec3d{};
    const double way = std::max(length(a), length(b));
    const double own = way > t.catches_up ? t.catches_up / way : 1;
    const double part = t.catches_up > 0 ? own : t.part;
    t.w.obstacle_moves[2 * o] = part * a;
    t.w.obstacle_moves[2 * o + 1] = part * b;
  }
}

/// Where a hold is when this solve ends, if all of it is taken.
Vec3d hold_target(const Tick& t, int k) noexcept {
  const HoldState& h = t.s.holds[k];
  return k < int(t.drive.holds.size()) ? h.seen + t.part * (t.drive.holds[k].x - h.seen) : h.seen;
}
Vec3d aim_target(const Tick& t, int k, double share) noexcept {
  const HoldState& h = t.s.holds[k];
  return normalised(h.aim + share * (t.drive.holds[k].direction - h.aim), h.aim);
}
Vec3d passage_target(const Tick& t, int k) noexcept {
  const PassageState& p = t.s.passages[k];
  return k < int(t.drive.passages.size()) ? p.seen + t.part * (t.drive.passages[k].x - p.seen) : p.seen;
}

/// That of the very curve on which the tissue's point is kept: what slides along another one would be driven by what
/// presses it against its hole.
Vec3d passage_direction(const Tick& t, int k) noexcept {
  const SmoothPlace at = smooth_place(t.m, t.s.passages[k].s);
  const Vec3d before = t.s.x[at.nodes[1]] - t.s.x[at.nodes[0]], after = t.s.x[at.nodes[2]] - t.s.x[at.nodes[1]];
  const double u = at.c[2] - at.c[0];
  return normalised((0.5 - u) * before + (0.5 + u) * after, t.w.along[at.nodes[0]]);
}
double passage_bound(const Tick& t, int k) noexcept {
  const Passage& p = t.drive.passages[k];
  const double mu = passage_friction(t, p);
  // What turns by theta in one point shall rub as if it did so round a bend: T2 = T1 e^(mu theta) + drag.
  const int e = place_at(t.m, t.s.passages[k].s).element, before = e > 0 ? e - 1 : e,
            after = e + 2 < t.m.nodes ? e + 1 : e;
  const double theta = portable::acos(dot(t.w.along[before], t.w.along[after]));
  const double c = portable::cos(0.5 * theta), s = portable::sin(0.5 * theta);
  const double grown = portable::exp(mu * theta);
  const double share = s > 1e-3 ? c / s * (grown - 1) / (grown + 1) : mu;
  return (p.drag * c + share * t.s.passages[k].press) / p.stiffness;
}

/// Skins are planes that nodes lie on. What friction does there is found as between elements.
Touch skin_touch(const Tick& t, int k) noexcept {
  const SkinContact& c = t.drive.skins[k];
  const Vec3d x = t.s.x[c.node];
  const double gap = dot(x - c.point, c.normal) - 0.5 * t.m.stuff.diameter;
  Touch touch{.a = c.node, .b = k, .normal = c.normal};
  if (gap >= 0.02 * t.m.stuff.diameter) return touch;
  set_skin_press(touch, c, t.m.stuff.diameter, gap);
  if (t.s.skins[k].node == c.node) {
    touch.strain = t.s.skins[k].rub.strain - dot(t.s.skins[k].rub.strain, c.normal) * c.normal;
    touch.reached = t.s.skins[k].rub.reached;
  }
  set_friction(touch, c.friction < 0 ? t.m.stuff.friction_tissue : c.friction, 0.5 * c.stiffness);
  touch.moved = t.h * c.velocity;
  return touch;
}
void move_slots(Tick& t, double share, const ThreadReactions& out) noexcept {
  const double k = hold_stiffness(t.m);
  for (int n = 0; n < t.m.holds; ++n) {
    HoldState& h = t.s.holds[n];
    if (!h.active || n >= int(t.drive.holds.size())) continue;
    const Hold& hold = t.drive.holds[n];
    h.seen += (share * t.part) * (hold.x - h.seen);
    if (!is_zero(hold.direction)) h.aim = aim_target(t, n, share * t.part);
    if (!is_zero(hold.side)) h.side = normalised(h.side + (share * t.part) * (hold.side - h.side), h.side);
    if (!(hold.friction_limit > 0)) continue;
    const Vec3d d = t.w.along[place_at(t.m, h.s).element];
    const double slipped = slip_along(t, point_at(t.m, t.s, h.s) - h.seen, d,
                                      {hold.friction_limit / k, k, kClipHalfWidth + kHolderHalfWidth}, h.s, h.reached);
    if (n < int(out.holds.size())) out.holds[n].slipped += slipped;
    if (!(h.s >= 0 && h.s <= t.m.length)) h = {};
  }
  for (int n = 0; n < std::min(t.m.passages, int(t.drive.passages.size())); ++n) {
    PassageState& p = t.s.passages[n];
    if (!p.active) continue;
    p.seen += (share * t.part) * (t.drive.passages[n].x - p.seen);
    const Vec3d d = passage_direction(t, n);
    const Vec3d off = smooth_place(t.m, p.s).of(t.s.x) - p.seen;
    const Vec3d across = off - dot(off, d) * d;
    p.press = t.drive.passages[n].stiffness * length(across);
    const Bears bears{passage_bound(t, n), t.drive.passages[n].stiffness, kClipHalfWidth, turning(t, n, across)};
    const double slipped = slip_along(t, off, d, bears, p.s, p.reached);
    if (n < int(out.passages.size())) out.passages[n].slipped += slipped;
    if (!(p.s >= 0 && p.s <= t.m.length)) p = {};
  }
  for (int o = 0; o < t.m.obstacles; ++o) {
    t.s.obstacles[o].a += share * t.w.obstacle_moves[2 * o];
    t.s.obstacles[o].b += share * t.w.obstacle_moves[2 * o + 1];
  }
  for (int n = 0; n < t.m.skins; ++n) {
    SkinState& skin = t.s.skins[n];
    if (!t.given_skin(n)) {
      skin = {};
      continue;
    }
    Touch touch = skin_touch(t, n);
    if (!(touch.press > 0)) {
      skin = {};
      continue;
    }
    const Vec3d motion = share * (t.w.delta[touch.a] - touch.moved);
    touch.strain += motion - dot(motion, touch.normal) * touch.normal;
    settle(touch);
    skin = {touch.a, {touch.strain, touch.reached}, t.drive.skins[n].point};
  }
}

bool undisturbed(const Tick& t) noexcept {
  if (!(motion_left(t) <= kStill)) return false;
  for (int n = 0; n < std::min(t.m.holds, int(t.drive.holds.size())); ++n) {
    const HoldState& h = t.s.holds[n];
    const Hold& given = t.drive.holds[n];
    if (h.active && !is_zero(given.direction) && length(h.aim - given.direction) > 1e-6) return false;
    if (h.active && !is_zero(given.side) && length(h.side - given.side) > 1e-6) return false;
  }
  for (int n = 0; n < t.m.skins; ++n) {
    const bool given = t.given_skin(n);
    const SkinState& skin = t.s.skins[n];
    if (given && skin.node >= 0 &&
        (skin.node != t.drive.skins[n].node || length(skin.point - t.drive.skins[n].point) > kStill))
      return false;
    if (skin.node < 0 ? given && skin_touch(t, n).press > 0 : !given) return false;
  }
  return true;
}

void report_reactions(const Tick& t, const ThreadReactions& out) noexcept {
  const double k = hold_stiffness(t.m);
  for (int n = 0; n < std::min(t.m.holds, int(out.holds.size())); ++n) {
    const HoldState& h = t.s.holds[n];
    if (!h.active) continue;
    out.holds[n].force = k * (point_at(t.m, t.s, h.s) - h.seen);
    const ThreadPlace at = place_at(t.m, h.s);
    const double force = length(out.holds[n].force), most = most_pull(t, at.element);
    if (t.taken < 1 && force > most) out.holds[n].force *= most / force;
    if (n >= int(t.drive.holds.size()) || is_zero(t.drive.holds[n].direction)) continue;
    const Vec3d d = t.s.x[at.element + 1] - t.s.x[at.element];
    out.holds[n].moment = turn_stiffness(t.m) * cross(h.aim, d) * dot(h.aim, d);
  }
  for (int n = 0; n < std::min({t.m.passages, int(out.passages.size()), int(t.drive.passages.size())}); ++n) {
    const PassageState& p = t.s.passages[n];
    if (!p.active) continue;
    out.passages[n].force = t.drive.passages[n].stiffness * (smooth_place(t.m, p.s).of(t.s.x) - p.seen);
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
  if (t.taken < 1) keep_to_what_pulls(t, out.obstacles);
  for (int n = 0; n < std::min({t.m.skins, int(out.skins.size()), int(t.drive.skins.size())}); ++n) {
    if (!t.given_skin(n)) continue;
    const Touch touch = skin_touch(t, n);
    out.skins[n] = touch.rub_stiffness * touch.strain - touch.press * touch.normal;
  }
}

}  // namespace trocar::suture
