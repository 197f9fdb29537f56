// What is wound is drawn over the tail, and tight.
#include <algorithm>
#include <cmath>

#include <trocar/training/skills/suture/tying.hpp>

namespace trocar::training {
namespace {

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
                          kLifted = 0.022, kLeastLifted = 0.006, kGently = 0.15, kOffAt = 0.25, kStays = 0.5,
                          kStillOn = 0.6, kFirmly = 0.5, kAside = 1, kStraight = 0.25, kSlowly = 0.05, kEven = 0.2,
                          kMostOf = 0.8, kLongest = 6, kLongestOff = 14, kSeenOf = 0.9,
                          kPressed = 0.6;  // [m/s], [m], [s], [N]
  static constexpr int kMostAgain = 2;

  void start(Operator& op, int) override {
    m_offset = op.arm(m_with).tip - op.arm(m_hand).tip;
    m_reach_now = m_reach, m_ahead_now = m_ahead;
    m_gone = 0, m_off_for = 0, m_kept = 0, m_again = 0;
    m_ties = tying::ties(op);
    m_free = tying::free_thread(op, m_with);
    // the jaws draw back out of what is wound, and the tail must be long enough for it
    const double tail = tying::free_thread(op, m_hand);
    m_lifted = m_ties ? std::clamp(tail - m_back, kLeastLifted, kLifted) : kLifted;
    m_dir = normalised(m_way, {1, 0, 0});
  }
  void off(Operator& op) {
    m_far = op.tool_state(m_hand).depth - m_back;
    m_off_for = 0, m_gone = 0;
    go(kOff);
  }
  /// What is wound is drawn tight round the jaws instead of over the tail: they are pressed, and the tail is not
  /// pulled.
  bool lies_on_jaws(const Operator& op) const {
    const double(&touched)[3] = op.tool_state(m_hand).contact_force;
    const double pressed = -dot(Vec3d{touched[0], touched[1], touched[2]}, m_dir);
    return pressed > kPressed && pressed > 2 * tying::pull_of(op, m_hand);
  }
  bool both_hold(const Operator& op) const {
    return held_of_suture(op.model(), op.state(), std::size_t(m_hand)) != 0 &&
           held_of_suture(op.model(), op.state(), std::size_t(m_with)) != 0;
  }
  Progress work(Operator& op) override {
    tying::watch(op);
    if (!both_hold(op)) return fail("the jaws have lost the thread");
    op.want(op.arm(m_hand).tip);
    op.want(op.arm(m_with).tip);
    Vec3d stitch;
    if (!tying::find_stitch(op, stitch)) return fail("the thread is in no tissue");
    if (m_phase == kLift) {  // as far above the tissue as the tail lets it, so that there is room ahead of the jaws
      const Vec3d up = tying::upwards(op), home = op.arm(m_hand).port - stitch;
      const Vec3d high = stitch + m_lifted * (up + 0.3 * normalised(home - dot(home, up) * up));
      const bool lifted = tying::pull_of(op, m_hand) > kFirmly || op.arms().move(m_hand, high, pace::kCareful);
      op.arms().move(m_with, op.arm(m_hand).tip + m_offset, 2 * pace::kTravel);
      if (lifted || m_in_phase > kLongest) off(op);
      return Progress::working;
    }
    const double left = std::fabs(wraps_around(op.model(), op.state(), m_hand));
    if (m_phase == kOff) {
      // the thread is led ahead of the jaws, along them, and these are drawn out of what is wound: pulled tight it
      // would not slide
      const Vec3d axis = normalised(op.arm(m_hand).tip - op.arm(m_hand).port);
      const Vec3d ahead =
          tying::above_tissue(op, m_with, op.arm(m_hand).tip + m_ahead_now * normalised(axis - kAside * m_dir));
      // what is wide comes off later; who pulls gives way, or what is wound is drawn tight round the jaws
      const double thread = tying::tension_from(op, m_with, kSeenOf * m_free);
      if (thread > kFirmly) {
        tying::lead(op, m_with, op.arm(m_hand).tip, kTight);
        m_ahead_now = std::max(0.0, m_ahead_now - kTight * sim::kTick);
      } else if (tying::lead(op, m_with, ahead, pace::kCareful)) {
        m_ahead_now += 0.5 * kPace * sim::kTick;
      }
      if (tying::pull_of(op, m_hand) < kGently && thread < kFirmly)
        op.arms().move_to_depth(m_hand, m_far, pace::kTrack);
      // loops that are off lie about the tail beside the jaws for a while, and are counted with what is on them
      m_off_for = left < kOffAt ? m_off_for + sim::kTick : 0;
      if (m_off_for > kStays || m_in_phase > kLongestOff) go(kPost);
      return Progress::working;
    }
    const double tail = tying::felt_by(op, m_hand, m_dir), other = tying::felt_by(op, m_with, -m_dir);
    const auto pace_at = [&](double pull) { return pull > kSlowly ? kTight : kPace; };
    const double step = pace_at(other) * sim::kTick;
    const Vec3d above = stitch + kAbove * tying::upwards(op);
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
      if (tail < kFirmly && lies_on_jaws(op) && m_again++ < kMostAgain) return off(op), Progress::working;
      if (m_gone == 0) m_gone = std::max(0.0, dot(above - tying::held_thread(op, m_with), m_dir));
      m_gone += step, tying::lead(op, m_with, above - m_gone * m_dir, pace_at(other));
      if (other >= kStraight || tail >= kFirmly) go(kKeep);
      return m_gone > kFarthest ? fail("it does not come tight") : Progress::working;
    }
    if (m_phase == kKeep) {
      // evenly: who pulls more waits, or the throw turns over and what is tied is drawn off the tissue
      const bool borne = std::max(tail, other) < m_pull + kEven;  // thread may lie about jaws that do not feel it
      if (borne && tail < std::min(m_pull, other + kEven)) op.arm(m_hand).tip += pace_at(tail) * sim::kTick * m_dir;
      if (borne && other < std::min(m_pull, tail + 2 * kEven)) op.arm(m_with).tip -= step * m_dir;
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
                                                   m_off_for = 0, m_kept = 0, m_free = 0, m_lifted = 0;
  int m_again = 0;
  bool m_ties = false;
  Vec3d m_dir, m_offset;
};

}  // namespace

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
    45,
    "Draws what is wound round the jaws over the tail, and both hands apart.",
    &tying::lacks_thread,
    &making<PullThrow>};

}  // namespace trocar::training
