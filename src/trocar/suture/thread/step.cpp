// One tick of a thread: as many linear solves as the motion of what leads it asks for.
#include <algorithm>
#include <cmath>

#include <trocar/suture/thread/contacts.hpp>
#include <trocar/suture/thread/spin.hpp>
#include <trocar/suture/thread/tick.hpp>

namespace trocar::suture {
namespace {

constexpr double kFreeMotion = 0.2;   ///< that a solve is asked to follow where nothing touches, in spacings
constexpr double kMostMotion = 0.5;   ///< and at the very most, in diameters
constexpr double kMostTurn = 0.5;     ///< that a solve may turn an element, about [rad]: it is linear
constexpr int kCalmTicks = 200;       ///< after which a thread that is still sleeps
constexpr double kStillSpeed = 1e-6;  ///< [m/s]
constexpr double kForgotten = 0.02;   ///< share of a tick that is not worth another solve
constexpr double kKnotPress =
    0.25;                           ///< of its pull: where thread presses harder on itself, it is knotted. Our estimate
constexpr double kBesideKnot = 20;  ///< [diameters] of thread to each side of a knot's middle: the pull on the knot is
                                    ///< the greatest there. Longer than a knot of four throws. Our estimate

/// The share of what is left that the next solve takes.
void choose_part(Tick& t) {
  const double motion = motion_left(t);
  const double wanted = t.s.self_count + t.s.touch_count > 0 ? t.m.solve_motion : kFreeMotion * t.m.spacing;
  const double needed = std::min(motion / (t.m.most_solves - t.solves), kMostMotion * t.m.stuff.diameter);
  const double most = std::max(wanted, needed);
  t.part = motion > most ? most / motion : 1;
  t.catches_up = needed == kMostMotion * t.m.stuff.diameter ? needed : 0;
  t.h = t.m.tick * t.left * t.part;
  set_obstacle_moves(t);
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

/// How far an element is turned, at most: it would be stretched by that.
double fastest_turn(const Tick& t) {
  double most = 0;
  for (int e = 0; e + 1 < t.m.nodes; ++e) {
    if (!t.s.alive[e]) continue;
    const Vec3d apart = t.w.delta[e + 1] - t.w.delta[e];
    const double along = dot(apart, t.w.along[e]);
    most = std::max(most, (dot(apart, apart) - along * along) / (t.w.length[e] * t.w.length[e]));
  }
  return std::sqrt(most);
}

/// How much of a solution is taken: no node goes so far that it may have met what is not looked at, and nothing passes
/// through anything.
double share_of_step(Tick& t) {
  double most = 0;
  for (int i = 0; i < t.m.nodes; ++i) most = std::max(most, dot(t.w.delta[i], t.w.delta[i]));
  most = std::sqrt(most);
  if (!(most < 1)) return -1;
  const double room = 0.5 * (t.reach - t.m.stuff.diameter) - t.moved;
  double share = safe_share(t.m, t.s, t.near, t.drive.obstacles, most, t.w);
  if (share * most > room) share = room / most;
  const double turn = fastest_turn(t);
  return share * turn > kMostTurn ? kMostTurn / turn : share;
}

void find_contacts(Tick& t) {
  t.self = find_touching(t.m, t.s, t.near, t.w, t.full, t.closest);
  t.touching = find_obstacles(t.m, t.s, t.drive.obstacles, t.w, t.full);
}

/// The element's director as a hold wants it.
Vec3d wanted_director(const HoldState& h) {
  return h.material.x * h.aim + h.material.y * h.side + h.material.z * cross(h.aim, h.side);
}

void spin_after(Tick& t) {
  measure(t);
  measure_twist(t.m, t.s, t.w);
  SpinHold holds[16];
  int count = 0;
  for (int k = 0; k < std::min(t.m.holds, int(t.drive.holds.size())) && count < 16; ++k)
    if (t.s.holds[k].active && !is_zero(t.drive.holds[k].side))
      holds[count++] = {place_at(t.m, t.s.holds[k].s).element, wanted_director(t.s.holds[k])};
  relax_spin(t.m, {holds, std::size_t(count)}, t.self, t.touching, t.s, t.w);
}

bool solve_once(Tick& t, const ThreadReactions& out) {
  choose_part(t);
  look_around(t);
  find_contacts(t);
  couple_touching(t);
  add_terms(t);
  if (t.w.system.factor() >= 0) return false;
  t.w.system.solve();
  for (int i = 0; i < t.m.nodes; ++i) t.w.delta[i] = t.w.system.unknown(i);
  const double share = share_of_step(t);
  if (!(share >= 0)) return false;
  t.taken = share;
  end_touches(t, share);
  move_nodes(t, share);
  spin_after(t);
  settle_touches(t);
  flow(t);
  move_slots(t, share, out);
  settle_clips(t);
  t.left *= 1 - share * t.part;
  return true;
}

void clear(const ThreadReactions& out) {
  std::fill(out.holds.begin(), out.holds.end(), HoldReaction{});
  std::fill(out.obstacles.begin(), out.obstacles.end(), ObstacleReaction{});
  std::fill(out.skins.begin(), out.skins.end(), Vec3d{});
  std::fill(out.passages.begin(), out.passages.end(), PassageReaction{});
}

/// The greatest tension beside a place of the thread [N]. @param s  of the place [m]
double pull_beside(const Tick& t, double s) {
  const int at = place_at(t.m, s).element, reach = int(kBesideKnot * t.m.stuff.diameter / t.m.spacing) + 1;
  double most = 0;
  for (int e = std::max(0, at - reach); e < std::min(t.m.nodes - 1, at + reach + 1); ++e)
    most = std::max(most, tension(t.m, t.s, e));
  return most;
}

/// Where it is knotted: two of its places are tied, or it is bent about itself and pressed there; below 0: nowhere.
/// Stretches that lie on each other without a load weaken neither.                                              [m]
double knot_at(const Tick& t, double pull) {
  for (const TieState& tie : t.s.ties)
    if (tie.active) return tie.t;
  const auto end = t.w.self.begin() + t.self;
  const auto hardest =
      std::max_element(t.w.self.begin(), end, [](const Touch& a, const Touch& b) { return a.press < b.press; });
  return hardest != end && hardest->press > kKnotPress * pull ? (hardest->a + 0.5) * t.m.spacing : -1;
}

/// A knot that is pulled with more than its thread bears there, knotted; below 0: none. A knot elsewhere along the
/// thread weakens nothing. [m]
double overloaded_knot(const Tick& t, double pull) {
  const double knot = knot_at(t, pull);
  return knot >= 0 && pull_beside(t, knot) > t.m.stuff.knotted_break_force ? knot : -1;
}

/// A straight thread bears its breaking force, a knotted one its knot pull strength, and parts at the knot. [knot pull]
void report_weakest(const Tick& t, ThreadReport& report) {
  if (!(report.tension > t.m.stuff.knotted_break_force)) return;
  const double knot = overloaded_knot(t, report.tension);
  if (knot < 0 && !(report.tension > t.m.stuff.break_force)) return;
  report.flags |= ThreadReport::kOverloaded;
  if (knot >= 0) report.weakest = knot;
}

void report_loads(const Tick& t, ThreadReport& report) {
  for (int e = 0; e + 1 < t.m.nodes; ++e) {
    const double pull = tension(t.m, t.s, e);
    if (pull > report.tension) report.tension = pull, report.weakest = (e + 0.5) * t.m.spacing;
  }
  const double closest = std::min(t.closest, closest_of(t.s, t.self, t.w));
  report.sunk = std::max(0.0, 1 - closest / t.m.stuff.diameter);
  report_weakest(t, report);
  report.contacts = t.self;
  report.coupled = report.asleep ? 0 : t.w.system.coupled();
  report.lag = motion_left(t);
  if (report.lag > 0.1 * t.m.stuff.diameter) report.flags |= ThreadReport::kLagging;
  if (t.full) report.flags |= ThreadReport::kFull;
}

/// A thread that lies still sleeps: it stays where it is, and what it does to others stays the same.
void sleep_on(Tick& t) {
  for (int o = 0; o < 2 * t.m.obstacles; ++o) t.w.obstacle_moves[o] = {};
  t.reach = 1.4 * t.m.stuff.diameter;
  t.near = find_near(t.m, t.s, t.reach, t.w);
  find_contacts(t);
  for (Touch* touches : {t.w.self.data(), t.w.touch.data()})
    for (int k = 0; k < (touches == t.w.self.data() ? t.self : t.touching); ++k)
      touches[k].force = touches[k].press * touches[k].normal - touches[k].rub_stiffness * touches[k].strain;
}

bool still(const ThreadState& s) {
  for (const Vec3d& v : s.v)
    if (!(dot(v, v) < kStillSpeed * kStillSpeed)) return false;
  return true;
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
  measure(t);
  begin_slots(t);
  const bool calm = undisturbed(t);
  report.asleep = calm && s.calm >= kCalmTicks;
  if (report.asleep) sleep_on(t);
  for (; !report.asleep && t.solves < m.most_solves && t.left > kForgotten; ++t.solves) {
    ++report.solves;
    if (!solve_once(t, reactions)) {
      report.flags |= ThreadReport::kIndefinite;
      break;
    }
  }
  if (!report.asleep) pose_clips(m, s);
  if (!report.asleep) s.calm = calm && still(s) ? s.calm + 1 : 0;
  report_reactions(t, reactions);
  report_loads(t, report);
  return report;
}

}  // namespace trocar::suture
