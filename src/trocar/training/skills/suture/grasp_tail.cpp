// Jaws that have been wound round take the tail.
#include <algorithm>
#include <cmath>

#include <trocar/suture/thread/chain.hpp>
#include <trocar/training/skills/suture/tying.hpp>

namespace trocar::training {
namespace {

/// Open jaws around the thread's tail, then closed; the hand that holds the thread goes along.
class GraspTail final : public Skill {
 public:
  GraspTail(const sim::Model&, const SkillArgs& args)
      : m_hand(args.hand()),
        m_with(args("with").given ? args("with").index : -1),
        m_at(args.number("at_mm", 0.006)),
        m_apart(args.number("apart_mm", 0)),
        m_open(args.number("open_to", 0.5)) {}

 private:
  enum Phase { kAway, kReach, kEnter, kClose };
  static constexpr double kInside = 0.7, kFeels = 0.3, kBare = 0.5, kLongest = 4, kThere = 0.001,
                          kShift = 0.0015;  // of the jaws' length, [s], [m]
  /// Jaws that have missed it draw back just far enough, or what is wound round them detaches.
  static constexpr double kBefore = 0.014, kBeforeAgain = 0.008;           // [m]
  static constexpr double kSwings = 2, kNearer = 0.004, kNearest = 0.016;  // [s], [m/s], [m] from its end
  static constexpr int kMostAgain = 5;

  void start(Surgeon& op, int tries) override {
    m_beside = 0.0015 * (tries % 3);
    m_shift = {0, 0, 0}, m_again = 0, m_bare_for = 0;
    if (m_with < 0) return go(kReach);
    m_free = 0.9 * tying::free_thread(op, m_with);
    m_offset = op.arm(m_with).tip - op.arm(m_hand).tip;
    m_offset += m_apart * normalised(op.arm(m_with).port - op.arm(m_with).tip);
  }
  /// As far as the hand that reaches, and nearer when the thread is taut.
  void follow(Surgeon& op) {
    if (m_with < 0) return;
    if (tying::tension_from(op, m_with, m_free) > 0.15) m_offset *= 1 - 0.5 * sim::kTick;
    op.arms().move(m_with, op.arm(m_hand).tip + m_offset, 2 * pace::kTravel);
  }
  Progress work(Surgeon& op) override {
    tying::watch(op);
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
    if (m_bare_for > kFeels) return fail("the turns round the jaws were lost");
    // A tail turns with its knot, and that with the thread that jaws which are wound round draw after them: nearer to
    // the knot it can be caught up with.
    if (m_phase == kReach && m_in_phase > kSwings)
      m_beside = std::min(kNearest - m_at, m_beside + kNearer * sim::kTick);
    if (m_phase == kAway) {  // the other hand draws back, so that its jaws are not within what is wound
      if (length(op.arm(m_with).tip - op.arm(m_hand).tip - m_offset) < kThere || m_in_phase > kFeels + 2) go(kReach);
    } else if (m_phase == kReach) {
      op.arms().turn_across(m_hand, runs);
      const bool open = op.arms().grip(m_hand, m_open, 0.8);
      const double before = m_again == 0 ? kBefore : kBeforeAgain;
      if (op.arms().move(m_hand, tip - before * along, pace::kCareful) && open) go(kEnter);
    } else if (m_phase == kEnter) {
      op.arms().turn_across(m_hand, runs);
      if (op.arms().move(m_hand, tip, pace::kCareful) || m_in_phase > kLongest) go(kClose);
    } else {
      if (!op.arms().grip(m_hand, 1, 0.6) || m_in_phase < kFeels + 0.6) return Progress::working;
      Vec3d off;
      if (has_tail(op, at) && !pinches_other(op, at, off)) return Progress::done;
      if (++m_again > kMostAgain) return fail("the jaws did not grasp the tail alone");
      m_shift += kShift * off;
      m_beside += m_again % 2 == 0 ? -0.003 : 0.005;
      go(kReach);
    }
    return Progress::working;
  }

  bool has_tail(const Surgeon& op, double at) const {
    constexpr double kTail = 0.010;  // [m] of thread
    if (held_of_suture(op.model(), op.state(), std::size_t(m_hand)) != 2) return false;
    const suture::ThreadState& thread = suture_of(op.state()).thread;
    return std::fabs(thread.holds[std::size_t(interactions::kFirstHandSlot + m_hand)].s - at) < kTail;
  }
  /// The closed jaws have thread between them that is not the tail; `off`: unit, away from it.
  bool pinches_other(const Surgeon& op, double at, Vec3d& off) const {
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
      off = normalised(towards_tail(op, beside), any_perpendicular(axis));
    }
    return nearest < between;
  }
  /// Towards the tail's side of the jaws, seen from the other stretch.
  Vec3d towards_tail(const Surgeon& op, Vec3d beside) const {
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

}  // namespace

const SkillKind kGraspTail{
    "grasp_tail",
    "take the tail",
    {hand_parameter(),
     {"with", ArgumentKind::hand, "the hand that follows, so that the turns stay on the jaws", false},
     number_parameter("at_mm", "distance from the thread's end; default 6", 1, 100),
     number_parameter("apart_mm", "distance that the other hand draws back before; default 0", 0, 100),
     number_parameter("open_to", "closing of the handle before; default 0.5", 0, 1)},
    20,
    "Encloses the thread near its free end with open jaws and closes them.",
    &tying::lacks_thread,
    &making<GraspTail>};

}  // namespace trocar::training
