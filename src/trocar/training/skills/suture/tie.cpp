// Throws: the thread that one hand holds is wound round the other one's jaws, these take the tail, and both draw apart.
#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/suture/thread/chain.hpp>
#include <trocar/training/observe/stitches.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Where the thread leaves what a hand holds of the suture.
Vec3d held_thread(const Operator& op, int hand) {
  const interactions::SutureModel& m = suture_of(op.model());
  const interactions::SutureState& s = suture_of(op.state());
  if (held_of_suture(op.model(), op.state(), std::size_t(hand)) == 1)
    return suture::needle_point(m.needle, s.needle, m.needle.length);
  const std::size_t slot = std::size_t(interactions::kFirstHandSlot + hand);
  if (slot < s.thread.holds.size() && s.thread.holds[slot].active)
    return suture::point_at(m.thread, s.thread, s.thread.holds[slot].s);
  return op.arm(hand).tip;
}
double pull_of(const Operator& op, int hand) {
  const double* f = op.tool_state(hand).pull;
  return length(Vec3d{f[0], f[1], f[2]});
}

Vec3d upwards(const Operator& op) { return -normalised(op.model().gravity, {0, 0, -1}); }
/// The middle of the stitch, as high as the highest place where thread lies in tissue; jaws stay above it.
bool find_stitch(const Operator& op, Vec3d& middle) {
  const interactions::SutureState& s = suture_of(op.state());
  const Vec3d up = upwards(op);
  Vec3d sum{};
  double high = -1e9, count = 0;
  for (int i = 0; i < s.hole_count; ++i) {
    if (s.holes[std::size_t(i)].slot < 0) continue;
    const Vec3d at = suture::point_at(suture_of(op.model()).thread, s.thread, double(s.holes[std::size_t(i)].arc));
    sum += at, count += 1, high = std::max(high, dot(up, at));
  }
  if (count == 0) return false;
  middle = (1 / count) * sum;
  middle += (high - dot(up, middle)) * up;
  return true;
}
/// Where the hand holds the thread, or the needle that it hangs on [m].
double held_at(const Operator& op, int hand) {
  const suture::ThreadState& thread = suture_of(op.state()).thread;
  const std::size_t slot = std::size_t(interactions::kFirstHandSlot + hand);
  return slot < thread.holds.size() && thread.holds[slot].active ? thread.holds[slot].s : 0;
}
/// Thread between what the hand holds of it and the last throw, or the stitch [m].
double free_thread(const Operator& op, int hand) {
  const interactions::SutureState& s = suture_of(op.state());
  const suture::KnotReading knot = knot_of(op.model(), op.state());
  double until = knot.count > 0 ? knot.tail : suture_of(op.model()).thread.length;
  for (int i = 0; i < s.hole_count; ++i)
    if (s.holes[std::size_t(i)].slot >= 0) until = std::min(until, double(s.holes[std::size_t(i)].arc));
  return std::max(0.0, until - held_at(op, hand));
}
/// The largest tension in that much thread beyond the hand that holds it; in throws that have been drawn tight there is
/// some that is no business of the hand's [N].
double tension_from(const Operator& op, int hand, double much) {
  const suture::ThreadModel& m = suture_of(op.model()).thread;
  const int from = int(held_at(op, hand) / m.spacing), to = std::min(m.nodes - 1, from + int(much / m.spacing));
  double most = 0;
  for (int e = from; e < to; ++e) most = std::max(most, suture::tension(m, suture_of(op.state()).thread, e));
  return most;
}
/// No lower than a little above where the thread leaves tissue.
Vec3d above_tissue(const Operator& op, Vec3d at) {
  constexpr double kLow = 0.010;  // [m]
  Vec3d stitch;
  if (!find_stitch(op, stitch)) return at;
  const Vec3d up = upwards(op);
  return at + std::max(0.0, kLow + dot(up, stitch - at)) * up;
}
/// The place where the thread is held to there.
bool lead(Operator& op, int hand, Vec3d to, double speed) {
  return op.arms().move(hand, op.arm(hand).tip + (to - held_thread(op, hand)), speed);
}

/// Round and round the other hand's jaws, which stand still.
class Wrap final : public Skill {
 public:
  Wrap(const sim::Model&, const Given& given)
      : m_hand(given.hand()),
        m_around(given("around").index),
        m_turns(given.number("turns", 1)),
        m_sense(given.says("way", "left") ? -1 : 1),
        m_pull(given.number("pull_N", 0.3)) {}

 private:
  enum Phase { kStand, kBegin, kTurn };
  static constexpr double kMostMore = 4;                                                  // turns made again
  static constexpr double kBeyond = 0.32, kUp = 0.3, kRadius = 0.21, kAhead = -0.18;      // of the thread that is free
  static constexpr double kMostUsed = 0.112;                                              // [m] of it: there is a lid
  static constexpr double kLongestStand = 6;                                              // [s]
  static constexpr double kSeenOf = 0.9;                                                  // of it is seen to be taut
  static constexpr double kSpare = 0.4;                                                   // of a turn, that is lost
  static constexpr double kPace = 0.035, kTighter = 0.03, kWider = 0.02, kLeast = 0.004;  // [m/s], [m]

  void start(Operator& op, int) override {
    m_angle = 0;
    // with more thread the jaws stand farther from the stitch, as what is wound hangs between them
    Vec3d stitch = op.arm(m_around).tip;
    find_stitch(op, stitch);
    m_free = free_thread(op, m_hand);
    const double size = std::min(m_free, kMostUsed);
    const Vec3d up = upwards(op), across = stitch - op.arm(m_around).port;
    m_stand = stitch + kBeyond * size * normalised(across - dot(across, up) * up) + kUp * size * up;
    m_radius = kRadius * size, m_ahead = kAhead * size;
  }
  Progress work(Operator& op) override {
    if (held_of_suture(op.model(), op.state(), std::size_t(m_hand)) == 0) return fail("the jaws have lost the thread");
    op.want(op.arm(m_around).tip);
    op.want(op.arm(m_hand).tip);
    const Vec3d q = held_thread(op, m_hand);
    if (m_phase == kStand) {
      if (!op.arms().grip(m_around, 1, 0.5)) return Progress::working;  // open, they would take thread along
      const bool stands = op.arms().move(m_around, m_stand, pace::kTravel);
      m_axis = normalised(op.arm(m_around).tip - op.arm(m_around).port);
      if ((turn_swage(op, -m_axis) && stands) || m_in_phase > kLongestStand) {
        m_centre = op.arm(m_around).tip + m_ahead * m_axis;
        const Vec3d off = q - m_centre;
        m_from = normalised(off - dot(off, m_axis) * m_axis, any_perpendicular(m_axis));
        m_to = double(m_sense) * cross(m_axis, m_from);
        m_now = m_radius;
        go(kBegin);
      }
      return Progress::working;
    }
    if (m_phase == kBegin) {
      if (lead(op, m_hand, m_centre + m_now * m_from, pace::kTravel)) go(kTurn);
      return Progress::working;
    }
    turn_swage(op, m_centre - q);
    const double taut = tension_from(op, m_hand, kSeenOf * m_free);
    if (taut > m_pull) m_now = std::max(kLeast, m_now - kTighter * sim::kTick);
    if (taut < 0.5 * m_pull) m_now = std::min(m_radius, m_now + kWider * sim::kTick);
    if (taut < 4 * m_pull) m_angle += kPace / std::max(0.01, m_now) * sim::kTick;
    const Vec3d round = m_centre + m_now * (portable::cos(m_angle) * m_from + portable::sin(m_angle) * m_to);
    lead(op, m_hand, before_jaws(op, above_tissue(op, round)), 2 * pace::kTravel);
    // what lies round jaws loosely may come off over their tip, and then it is wound anew; counted from the needle
    const double wound = -double(m_sense) * wraps_around(op.model(), op.state(), m_around);
    if (wound > m_turns + kSpare) return Progress::done;
    return m_angle > portable::two_pi * (m_turns + kMostMore) ? fail("what is wound comes off the jaws")
                                                              : Progress::working;
  }
  /// Farther ahead where this shaft would cross those jaws.
  Vec3d before_jaws(const Operator& op, Vec3d at) const {
    constexpr double kBefore = 0.007, kNear = 0.008, kFar = 0.014, kFarthest = 0.025;  // [m] between middle lines
    const Vec3d port = op.arm(m_hand).port, tip = op.arm(m_around).tip, far = op.arm(m_around).port;
    const Vec3d shaft = at - port, jaws = tip + kBefore * m_axis - far;
    const suture::NearestPlaces near = suture::nearest_places(port, shaft, far, jaws, 1e-6);
    const Vec3d on_jaws = far + near.t * jaws;
    const double apart = length(port + near.s * shaft - on_jaws);
    const double share = std::clamp((kFar - apart) / (kFar - kNear), 0.0, 1.0);
    const double ahead = dot(tip - on_jaws, m_axis) + kBefore;
    return at + std::min(share * ahead, kFarthest) * m_axis;
  }
  /// Rolls the needle until its thread leaves it `towards`: what is wound round one hand's jaws winds itself round the
  /// other's too if these do not turn along.
  bool turn_swage(Operator& op, Vec3d towards) const {
    if (held_of_suture(op.model(), op.state(), std::size_t(m_hand)) != 1) return true;
    constexpr double kTurns = 2, kNear = 0.06, kSeen = 0.3;  // [rad/s] [rad], sine of the angle to the shaft
    Arms::Arm& arm = op.arm(m_hand);
    const suture::NeedleModel& m = suture_of(op.model()).needle;
    const Vec3d axis = normalised(arm.tip - arm.port), to = normalised(towards, axis);
    if (length(cross(axis, to)) < kSeen) return true;
    const Vec3d leaves = -suture::needle_direction(m, suture_of(op.state()).needle, m.length);
    const double off =
        portable::atan2(dot(cross(leaves, to), axis), dot(leaves, to) - dot(axis, leaves) * dot(axis, to));
    arm.roll -= std::clamp(off, -kTurns * sim::kTick, kTurns * sim::kTick);
    return std::fabs(off) < kNear;
  }

  int m_hand, m_around;
  double m_turns;
  int m_sense;
  double m_pull, m_free = 0, m_radius = 0, m_ahead = 0, m_angle = 0, m_now = 0;
  Vec3d m_stand, m_axis, m_centre, m_from, m_to;
};

/// Open jaws around the thread's tail, then closed; the hand that holds the thread goes along.
class GraspTail final : public Skill {
 public:
  GraspTail(const sim::Model&, const Given& given)
      : m_hand(given.hand()),
        m_with(given("with").given ? given("with").index : -1),
        m_at(given.number("at_mm", 0.006)),
        m_apart(given.number("apart_mm", 0)),
        m_open(given.number("open_to", 0.5)) {}

 private:
  enum Phase { kAway, kReach, kEnter, kClose };
  static constexpr double kInside = 0.7, kFeels = 0.3, kBare = 0.5, kLongest = 4, kThere = 0.001,
                          kShift = 0.0015;  // of the jaws' length, [s], [m]
  static constexpr int kMostAgain = 5;

  void start(Operator& op, int tries) override {
    m_beside = 0.0015 * (tries % 3);
    m_shift = {0, 0, 0}, m_again = 0, m_bare_for = 0;
    if (m_with < 0) return go(kReach);
    m_free = 0.9 * free_thread(op, m_with);
    m_offset = op.arm(m_with).tip - op.arm(m_hand).tip;
    m_offset += m_apart * normalised(op.arm(m_with).port - op.arm(m_with).tip);
  }
  /// As far as the hand that reaches, and nearer when the thread is taut.
  void follow(Operator& op) {
    if (m_with < 0) return;
    if (tension_from(op, m_with, m_free) > 0.15) m_offset *= 1 - 0.5 * sim::kTick;
    op.arms().move(m_with, op.arm(m_hand).tip + m_offset, 2 * pace::kTravel);
  }
  Progress work(Operator& op) override {
    const interactions::SutureModel& m = suture_of(op.model());
    const interactions::SutureState& s = suture_of(op.state());
    const double at = m.thread.length - m_at - m_beside, ahead = 0.002;
    const Vec3d p = suture::point_at(m.thread, s.thread, at);
    const Vec3d runs =
        normalised(suture::point_at(m.thread, s.thread, at + ahead) - suture::point_at(m.thread, s.thread, at - ahead));
    const Vec3d along = normalised(p - op.arm(m_hand).port);
    const Vec3d tip = p + m_shift + (1 - kInside) * op.tool(m_hand).jaw_length * along;
    op.want(p);
    op.want(op.arm(m_hand).tip);
    follow(op);
    m_bare_for =
        m_with >= 0 && std::fabs(wraps_around(op.model(), op.state(), m_hand)) < kBare ? m_bare_for + sim::kTick : 0;
    if (m_bare_for > kFeels) return fail("what was wound has come off");
    if (m_phase == kAway) {  // the other hand draws back, so that its jaws are not within what is wound
      if (length(op.arm(m_with).tip - op.arm(m_hand).tip - m_offset) < kThere || m_in_phase > kFeels + 2) go(kReach);
    } else if (m_phase == kReach) {
      op.arms().turn_across(m_hand, runs);
      const bool open = op.arms().grip(m_hand, m_open, 0.8);
      if (op.arms().move(m_hand, tip - 0.014 * along, pace::kCareful) && open) go(kEnter);
    } else if (m_phase == kEnter) {
      op.arms().turn_across(m_hand, runs);
      if (op.arms().move(m_hand, tip, pace::kCareful) || m_in_phase > kLongest) go(kClose);
    } else {
      if (!op.arms().grip(m_hand, 1, 0.6) || m_in_phase < kFeels + 0.6) return Progress::working;
      Vec3d off;
      if (has_tail(op, at) && !pinches_other(op, at, off)) return Progress::done;
      if (++m_again > kMostAgain) return fail("the jaws have not taken the tail alone");
      m_shift += kShift * off;
      m_beside += m_again % 2 == 0 ? -0.003 : 0.005;
      go(kReach);
    }
    return Progress::working;
  }

  bool has_tail(const Operator& op, double at) const {
    constexpr double kTail = 0.010;  // [m] of thread
    if (held_of_suture(op.model(), op.state(), std::size_t(m_hand)) != 2) return false;
    const suture::ThreadState& thread = suture_of(op.state()).thread;
    return std::fabs(thread.holds[std::size_t(interactions::kFirstHandSlot + m_hand)].s - at) < kTail;
  }
  /// The closed jaws have thread between them that is not the tail; `off`: unit, away from it.
  bool pinches_other(const Operator& op, double at, Vec3d& off) const {
    constexpr double kTail = 0.012;  // [m] of thread that is the tail
    const interactions::SutureModel& m = suture_of(op.model());
    const std::vector<Vec3d>& x = suture_of(op.state()).thread.x;
    const Vec3d tip = op.arm(m_hand).tip, axis = normalised(tip - op.arm(m_hand).port);
    const double between = 0.48 * op.tool(m_hand).jaw_width;
    double nearest = between;
    for (int i = 0; i * m.thread.spacing < at - kTail; ++i) {
      const Vec3d from = x[std::size_t(i)] - tip;
      const double ahead = dot(from, axis);
      if (ahead > 0 || ahead < -kInside * op.tool(m_hand).jaw_length) continue;
      const Vec3d beside = from - ahead * axis;
      if (length(beside) >= nearest) continue;
      nearest = length(beside);
      off = normalised(m_from_other(op, i, beside), any_perpendicular(axis));
    }
    return nearest < between;
  }
  /// Towards the tail's side of the jaws, seen from the other stretch.
  Vec3d m_from_other(const Operator& op, int, Vec3d beside) const {
    const interactions::SutureModel& m = suture_of(op.model());
    const interactions::SutureState& s = suture_of(op.state());
    const Vec3d tip = op.arm(m_hand).tip, axis = normalised(tip - op.arm(m_hand).port);
    const Vec3d tail = suture::point_at(m.thread, s.thread, m.thread.length - 0.020) - tip;
    return tail - dot(tail, axis) * axis - beside;
  }

  int m_hand, m_with;
  double m_at, m_apart, m_open, m_beside = 0;
  int m_again = 0;
  double m_free = 0, m_bare_for = 0;
  Vec3d m_offset, m_shift{0, 0, 0};
};

/// Off the jaws with what is wound round them, and apart until both pull.
class PullThrow final : public Skill {
 public:
  PullThrow(const sim::Model&, const Given& given)
      : m_hand(given.hand()),
        m_with(given("with").index),
        m_way{given.number("x_mm", 0), given.number("y_mm", 0), given.number("z_mm", 0)},
        m_pull(given.number("pull_N", 1.5)),
        m_back(given.number("back_mm", 0.012)),
        m_ahead(given.number("ahead_mm", 0.025)),
        m_reach(given.number("reach_mm", 0.022)),
        m_rest(given.number("for_s", 0.5)) {}

 private:
  enum Phase { kLift, kOff, kPost, kDraw, kKeep, kLoosen };
  static constexpr double kPace = 0.025, kTight = 0.004, kFarthest = 0.14, kGive = 0.002, kAbove = 0.004,
                          kLifted = 0.022, kGently = 0.15, kOffAt = 0.25, kStays = 0.5, kStillOn = 0.6, kFirmly = 0.5,
                          kAside = 1, kStraight = 0.25, kSlowly = 0.05, kEven = 0.2, kMostOf = 0.8, kLongest = 6,
                          kLongestOff = 14;  // [m/s], [m], [s]

  void start(Operator& op, int) override {
    m_offset = op.arm(m_with).tip - op.arm(m_hand).tip;
    m_reach_now = m_reach, m_ahead_now = m_ahead;
    m_gone = 0, m_off_for = 0, m_kept = 0;
    m_ties = knot_of(op.model(), op.state()).count > 0;
    m_dir = normalised(m_way, {1, 0, 0});
  }
  bool both_hold(const Operator& op) const {
    return held_of_suture(op.model(), op.state(), std::size_t(m_hand)) != 0 &&
           held_of_suture(op.model(), op.state(), std::size_t(m_with)) != 0;
  }
  Progress work(Operator& op) override {
    if (!both_hold(op)) return fail("the jaws have lost the thread");
    op.want(op.arm(m_hand).tip);
    op.want(op.arm(m_with).tip);
    Vec3d stitch;
    if (!find_stitch(op, stitch)) return fail("the thread is in no tissue");
    if (m_phase == kLift) {  // as far above the tissue as the tail lets it, so that there is room ahead of the jaws
      const Vec3d up = upwards(op), home = op.arm(m_hand).port - stitch;
      const Vec3d high = stitch + kLifted * (up + 0.3 * normalised(home - dot(home, up) * up));
      const bool lifted = pull_of(op, m_hand) > kGently || op.arms().move(m_hand, high, pace::kCareful);
      op.arms().move(m_with, op.arm(m_hand).tip + m_offset, 2 * pace::kTravel);
      if (lifted || m_in_phase > kLongest) {
        m_far = op.tool_state(m_hand).depth - m_back;
        m_off_for = 0;
        go(kOff);
      }
      return Progress::working;
    }
    const double left = std::fabs(wraps_around(op.model(), op.state(), m_hand));
    if (m_phase == kOff) {
      // the thread is led ahead of the jaws, along them, and these are drawn out of what is wound: pulled tight it
      // would not slide
      const Vec3d axis = normalised(op.arm(m_hand).tip - op.arm(m_hand).port);
      const Vec3d ahead = above_tissue(op, op.arm(m_hand).tip + m_ahead_now * normalised(axis - kAside * m_dir));
      // what is wide comes off later
      if (pull_of(op, m_with) < kFirmly && lead(op, m_with, ahead, pace::kCareful))
        m_ahead_now += 0.5 * kPace * sim::kTick;
      if (pull_of(op, m_hand) < kGently) op.arms().move_to_depth(m_hand, m_far, pace::kTrack);
      // loops that are off lie about the tail beside the jaws for a while, and are counted with what is on them
      m_off_for = left < kOffAt ? m_off_for + sim::kTick : 0;
      if (m_off_for > kStays || m_in_phase > kLongestOff) go(kPost);
      return Progress::working;
    }
    const double tail = pull_of(op, m_hand), other = pull_of(op, m_with);
    const auto pace_at = [&](double pull) { return pull > kSlowly ? kTight : kPace; };
    const double step = pace_at(other) * sim::kTick;
    const Vec3d above = stitch + kAbove * upwards(op);
    if (m_phase == kPost) {
      // The tail is drawn straight over what is tied, so that what is wound slides down along it and takes no slack
      // between; where nothing is tied it would be drawn out through the tissue.
      const bool there = op.arms().move(m_hand, above + m_reach_now * m_dir, pace_at(tail));
      if (there && m_ties) m_reach_now += pace_at(tail) * sim::kTick;
      if (left > kStillOn) return m_off_for = 0, go(kOff), Progress::working;
      if (tail >= kStraight || (there && !m_ties)) go(kDraw);
      return m_reach_now > kFarthest ? fail("the tail does not come straight") : Progress::working;
    }
    if (m_phase == kDraw) {
      if (m_gone == 0) m_gone = std::max(0.0, dot(above - held_thread(op, m_with), m_dir));
      m_gone += step, lead(op, m_with, above - m_gone * m_dir, pace_at(other));
      if (other >= kStraight) go(kKeep);
      return m_gone > kFarthest ? fail("it does not come tight") : Progress::working;
    }
    if (m_phase == kKeep) {
      // evenly: who pulls more waits, or the throw turns over and what is tied is drawn off the tissue
      if (tail < std::min(m_pull, other + kEven)) op.arm(m_hand).tip += pace_at(tail) * sim::kTick * m_dir;
      if (other < std::min(m_pull, tail + 2 * kEven)) op.arm(m_with).tip -= step * m_dir;
      m_kept += tail >= kMostOf * m_pull && other >= kMostOf * m_pull ? sim::kTick : 0;
      if (m_kept > m_rest || m_in_phase > kLongestOff) go(kLoosen);
      return Progress::working;
    }
    // hands give way before one lets go
    op.arm(m_hand).tip -= step * m_dir;
    op.arm(m_with).tip += step * m_dir;
    return m_in_phase * kPace > kGive ? Progress::done : Progress::working;
  }

  int m_hand, m_with;
  Vec3d m_way;
  double m_pull, m_back, m_ahead, m_reach, m_rest, m_reach_now = 0, m_ahead_now = 0, m_far = 0, m_gone = 0,
                                                   m_off_for = 0, m_kept = 0;
  bool m_ties = false;
  Vec3d m_dir, m_offset;
};

std::string lacks_thread(const sim::Model& model, const Given& given) {
  if (!needs_thread(model).empty()) return std::string(needs_thread(model));
  return lacks_tool(model, given.hand(), &interactions::Abilities::grip);
}

}  // namespace

const SkillKind kWrap{
    "wrap",
    "wind the thread round the other instrument",
    {hand_parameter("that holds needle or thread"),
     {"around", ArgumentKind::hand, "round whose jaws"},
     number_parameter("turns", "how often; 1", 0.25, 4),
     word_parameter("way", "seen along those jaws, turned as a right-handed screw as a rule", {"right", "left"}),
     number_parameter("pull_N", "the circle becomes smaller while the thread is pulled harder; 0.3", 0.01, 10)},
    30,
    "Leads the thread round the other hand's closed jaws, which stand still.",
    lacks_thread,
    &making<Wrap>};
const SkillKind kGraspTail{
    "grasp_tail",
    "take the tail",
    {hand_parameter(),
     {"with", ArgumentKind::hand, "whose hand goes along, so that what is wound round the jaws stays there", false},
     number_parameter("at_mm", "from the thread's end; 6", 1, 100),
     number_parameter("apart_mm", "that the other hand is drawn back before; 0", 0, 100),
     number_parameter("open_to", "how far the handle is closed before; 0.5", 0, 1)},
    20,
    "Puts open jaws around the thread near its free end and closes them.",
    lacks_thread,
    &making<GraspTail>};
const SkillKind kPullThrow{
    "pull_throw",
    "pull the throw tight",
    {hand_parameter("that holds the tail"),
     {"with", ArgumentKind::hand, "that holds needle or thread"},
     {"x_mm", ArgumentKind::number, "the tail's way, to the patient's left", true, -1000, 1000},
     {"y_mm", ArgumentKind::number, "towards the head", true, -1000, 1000},
     {"z_mm", ArgumentKind::number, "to the front", true, -1000, 1000},
     number_parameter("pull_N", "of either hand; 1.5", 0.1, 10),
     number_parameter("back_mm", "that the tail's hand is drawn back before; 12", 0, 150),
     number_parameter("ahead_mm", "of its jaws that the thread is led meanwhile; 25", 0, 150),
     number_parameter("reach_mm", "of the stitch's middle to which the tail's hand goes; 22", 5, 100),
     number_parameter("for_s", "how long they pull then; 0.5", 0, 10)},
    30,
    "Draws what is wound round the jaws over the tail, and both hands apart.",
    lacks_thread,
    &making<PullThrow>};

}  // namespace trocar::training
