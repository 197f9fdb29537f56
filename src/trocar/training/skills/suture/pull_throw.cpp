// What is wound is drawn over the tail, and tight.
#include <algorithm>
#include <cmath>

#include <trocar/training/skills/suture/tying.hpp>

namespace trocar::training {
namespace {

/// Off the jaws with what is wound round them, and apart until both pull.
class PullThrow final : public Skill {
 public:
  PullThrow(const sim::Model&, const SkillArgs& args)
      : m_hand(args.hand()),
        m_with(args("with").index),
        m_way{args.number("x_mm", 0), args.number("y_mm", 0), args.number("z_mm", 0)},
        m_pull(args.number("pull_N", 1.5)),
        m_back(args.number("back_mm", 0.012)),
        m_ahead(args.number("ahead_mm", 0.025)),
        m_reach(args.number("reach_mm", 0.022)),
        m_rest(args.number("for_s", 0.5)) {}

 private:
  enum Phase { kLift, kOff, kPost, kDraw, kKeep, kLoosen };
  static constexpr double kPace = 0.025, kTight = 0.004, kSlowly = 0.05;  // [m/s], [m/s] from what pull on [N]
  static constexpr double kFirmly = 0.5, kStraight = 0.25, kFarthest = 0.14, kAbove = 0.004;  // [N], [N], [m], [m]

  void start(Surgeon& op, int) override {
    constexpr double kLifted = 0.022, kLeastLifted = 0.006;  // [m]
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
  bool both_hold(const Surgeon& op) const {
    return held_of_suture(op.model(), op.state(), std::size_t(m_hand)) != 0 &&
           held_of_suture(op.model(), op.state(), std::size_t(m_with)) != 0;
  }
  Progress work(Surgeon& op) override {
    tying::watch(op);
    if (!both_hold(op)) return fail("the jaws lost the thread");
    op.want(op.arm(m_hand).tip);
    op.want(op.arm(m_with).tip);
    Vec3d stitch;
    if (!tying::find_stitch(op, stitch)) return fail("the thread is in no tissue");
    m_tail = tying::felt_by(op, m_hand, m_dir), m_other = tying::felt_by(op, m_with, -m_dir);
    const Vec3d above = stitch + kAbove * tying::upwards(op);
    switch (m_phase) {
      case kLift:
        return lift(op, stitch);
      case kOff:
        return slide_off(op);
      case kPost:
        return straighten_tail(op, above);
      case kDraw:
        return draw(op, above);
      case kKeep:
        return keep(op);
      default:
        return loosen(op);
    }
  }
  /// [m] in a tick of a hand that feels so much [N].
  static double step_at(double pull) { return pace_at(pull) * sim::kTick; }
  static double pace_at(double pull) { return pull > kSlowly ? kTight : kPace; }
  double wound(const Surgeon& op) const { return std::fabs(wraps_around(op.model(), op.state(), std::size_t(m_hand))); }

  /// As far above the tissue as the tail lets it, so that there is room ahead of the jaws.
  Progress lift(Surgeon& op, Vec3d stitch) {
    constexpr double kHomewards = 0.3, kLongest = 6;  // of the height, [s]
    const Vec3d up = tying::upwards(op), home = op.arm(m_hand).port - stitch;
    const Vec3d high = stitch + m_lifted * (up + kHomewards * normalised(home - dot(home, up) * up));
    const bool lifted = tying::pull_of(op, m_hand) > kFirmly || op.arms().move(m_hand, high, pace::kCareful);
    op.arms().move(m_with, op.arm(m_hand).tip + m_offset, 2 * pace::kTravel);
    if (lifted || m_in_phase > kLongest) begin_off(op);
    return Progress::working;
  }

  void begin_off(Surgeon& op) {
    m_far = op.tool_state(m_hand).depth - m_back;
    m_off_for = 0, m_gone = 0;
    go(kOff);
  }
  /// The thread is controlled ahead of the jaws, along them, and these are drawn out of what is wound: pulled tight it
  /// would not slide.
  Progress slide_off(Surgeon& op) {
    constexpr double kAside = 1, kSeenOf = 0.9, kGently = 0.15;   // of the way ahead, of the thread, [N]
    constexpr double kOffAt = 0.25, kStays = 0.5, kLongest = 14;  // of a turn, [s], [s]
    const Vec3d axis = normalised(op.arm(m_hand).tip - op.arm(m_hand).port);
    const Vec3d ahead =
        tying::above_tissue(op, m_with, op.arm(m_hand).tip + m_ahead_now * normalised(axis - kAside * m_dir));
    // what is wide detaches later; who pulls gives way, or what is wound is drawn tight round the jaws
    const double thread = tying::tension_from(op, m_with, kSeenOf * m_free);
    if (thread > kFirmly) {
      tying::lead(op, m_with, op.arm(m_hand).tip, kTight);
      m_ahead_now = std::max(0.0, m_ahead_now - kTight * sim::kTick);
    } else if (tying::lead(op, m_with, ahead, pace::kCareful)) {
      m_ahead_now += 0.5 * kPace * sim::kTick;
    }
    if (tying::pull_of(op, m_hand) < kGently && thread < kFirmly) op.arms().move_to_depth(m_hand, m_far, pace::kTrack);
    // loops that are off lie about the tail beside the jaws for a while, and are counted with what is on them
    m_off_for = wound(op) < kOffAt ? m_off_for + sim::kTick : 0;
    if (m_off_for > kStays || m_in_phase > kLongest) go(kPost);
    return Progress::working;
  }

  /// The tail is drawn straight over what is tied, so that what is wound slides down along it and takes no slack
  /// between; where nothing is tied it would be drawn out through the tissue.
  Progress straighten_tail(Surgeon& op, Vec3d above) {
    constexpr double kStillOn = 0.6;  // of a turn
    const bool there = op.arms().move(m_hand, above + m_reach_now * m_dir, pace_at(m_tail));
    if (there && m_ties) m_reach_now += step_at(m_tail);
    if (wound(op) > kStillOn) return m_off_for = 0, go(kOff), Progress::working;
    if (m_tail >= kStraight || (there && !m_ties)) go(kDraw);
    return m_reach_now > kFarthest ? fail("the tail did not straighten") : Progress::working;
  }

  /// What is wound is drawn tight round the jaws instead of over the tail: they are pressed, and the tail is not
  /// pulled.
  bool lies_on_jaws(const Surgeon& op) const {
    constexpr double kPressed = 0.6;  // [N]
    const double(&touched)[3] = op.tool_state(m_hand).contact_force;
    const double pressed = -dot(Vec3d{touched[0], touched[1], touched[2]}, m_dir);
    return pressed > kPressed && pressed > 2 * tying::pull_of(op, m_hand);
  }
  Progress draw(Surgeon& op, Vec3d above) {
    constexpr int kMostAgain = 2;
    if (m_tail < kFirmly && lies_on_jaws(op) && m_again++ < kMostAgain) return begin_off(op), Progress::working;
    if (m_gone == 0) m_gone = std::max(0.0, dot(above - tying::held_thread(op, m_with), m_dir));
    m_gone += step_at(m_other), tying::lead(op, m_with, above - m_gone * m_dir, pace_at(m_other));
    if (m_other >= kStraight || m_tail >= kFirmly) go(kKeep);
    return m_gone > kFarthest ? fail("the throw did not tighten") : Progress::working;
  }

  /// Evenly: who pulls more waits, or the throw turns over and what is tied is drawn off the tissue.
  Progress keep(Surgeon& op) {
    constexpr double kEven = 0.2, kMostOf = 0.8, kLongest = 14;     // [N], of the pull, [s]
    const bool borne = std::max(m_tail, m_other) < m_pull + kEven;  // thread may lie about jaws that do not feel it
    if (borne && m_tail < std::min(m_pull, m_other + kEven)) op.arm(m_hand).tip += step_at(m_tail) * m_dir;
    if (borne && m_other < std::min(m_pull, m_tail + 2 * kEven)) op.arm(m_with).tip -= step_at(m_other) * m_dir;
    m_kept += m_tail >= kMostOf * m_pull && m_other >= kMostOf * m_pull ? sim::kTick : 0;
    if (m_kept > m_rest || m_in_phase > kLongest) go(kLoosen);
    return Progress::working;
  }

  /// Hands give way before one lets go, and are still for as long as it takes to see what was tied.
  Progress loosen(Surgeon& op) {
    constexpr double kGive = 0.002, kLooks = 0.5;  // [m], [s]
    if (m_in_phase * kPace > kGive) return m_in_phase > kLooks ? Progress::done : Progress::working;
    op.arm(m_hand).tip -= step_at(m_other) * m_dir;
    op.arm(m_with).tip += step_at(m_other) * m_dir;
    return Progress::working;
  }

  int m_hand, m_with;
  Vec3d m_way;
  double m_pull, m_back, m_ahead, m_reach, m_rest;   // as given
  double m_tail = 0, m_other = 0;                    // what either hand feels against the way that it draws [N]
  double m_free = 0, m_lifted = 0;                   // thread at the start, height [m]
  double m_ahead_now = 0, m_far = 0, m_off_for = 0;  // of sliding off [m] [m] [s]
  double m_reach_now = 0, m_gone = 0, m_kept = 0;    // [m] [m] [s]
  int m_again = 0;
  bool m_ties = false;
  Vec3d m_dir, m_offset;
};

}  // namespace

const SkillKind kPullThrow{
    "pull_throw",
    "pull the throw tight",
    {hand_parameter("the hand that holds the tail"),
     {"with", ArgumentKind::hand, "the hand that holds needle or thread"},
     {"x_mm", ArgumentKind::number, "direction of the tail, to the patient's left", true, -1000, 1000},
     {"y_mm", ArgumentKind::number, "towards the head", true, -1000, 1000},
     {"z_mm", ArgumentKind::number, "to the front", true, -1000, 1000},
     number_parameter("pull_N", "pull of either hand; default 1.5", 0.1, 10),
     number_parameter("back_mm", "distance that the tail's hand draws back before; default 12", 0, 150),
     number_parameter("ahead_mm", "distance of the thread ahead of its jaws; default 25", 0, 150),
     number_parameter("reach_mm", "distance of the tail's hand from the middle of the stitch; default 22", 5, 100),
     number_parameter("for_s", "time that they pull then; default 0.5", 0, 10)},
    45,
    "Draws the turns off the jaws over the tail, and both hands apart.",
    &tying::lacks_thread,
    &making<PullThrow>};

}  // namespace trocar::training
