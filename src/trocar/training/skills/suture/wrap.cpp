// The thread that one hand holds is wound round the other one's jaws.
#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/suture/thread/chain.hpp>
#include <trocar/training/skills/suture/tying.hpp>

namespace trocar::training {
namespace {

/// Round and round the other hand's jaws, which stand still.
class Wrap final : public Skill {
 public:
  Wrap(const sim::Model&, const SkillArgs& args)
      : m_hand(args.hand()),
        m_around(args("around").index),
        m_turns(args.number("turns", 1)),
        m_sense(args.equals("way", "left") ? -1 : 1),
        m_pull(args.number("pull_N", 0.3)) {}

 private:
  enum Phase { kLay, kStand, kBegin, kTurn };
  static constexpr double kMostMore = 2.5;                                      // turns made again
  static constexpr double kBeyond = 0.034, kRadius = 0.023, kBehind = 0.021;    // [m] of the stitch, of the jaws' tip,
  static constexpr double kBeyondOf = 0.42, kRadiusOf = 0.3, kBehindOf = 0.28;  // and of thread that is short
  static constexpr double kUp = 0.3;                                            // of the thread that is free
  static constexpr double kMostUsed = 0.112;                                    // [m] of it: there is a lid
  static constexpr double kLaidBack[] = {0.5, 0, 0.7}, kLaidAside = 0.7, kLaidUp = 0.4;   // of it
  static constexpr double kTaut = 0.4, kLongestLay = 5;                                   // [N], [s]
  static constexpr double kLongestStand = 6;                                              // [s]
  static constexpr double kSeenOf = 0.9;                                                  // of it is seen to be taut
  static constexpr double kSpare = 0.4;                                                   // of a turn, that is lost
  static constexpr double kPace = 0.035, kTighter = 0.03, kWider = 0.02, kLeast = 0.004;  // [m/s], [m]

  void start(Surgeon& op, int tries) override {
    m_angle = 0;
    // with more thread the jaws stand further from the stitch, as what is wound hangs between them
    m_stitch = op.arm(m_around).tip;
    tying::find_stitch(op, m_stitch);
    m_free = tying::free_thread(op, m_hand);
    const double size = std::min(m_free, kMostUsed);
    const Vec3d up = tying::upwards(op), across = m_stitch - op.arm(m_around).port;
    const Vec3d back = -normalised(across - dot(across, up) * up), beside = cross(up, back);
    m_stand = m_stitch - std::min(kBeyond, kBeyondOf * size) * back + kUp * size * up;
    m_radius = std::min(kRadius, kRadiusOf * size), m_ahead = -std::min(kBehind, kBehindOf * size);
    // for the first throw it has just been drawn straight
    if (const bool first = !tying::ties(op); tries == 0 && first) return go(kStand);
    const double side = dot(tying::held_thread(op, m_hand) - m_stitch, beside) < 0 ? -1 : 1;
    m_laid = m_stitch + size * (kLaidBack[tries % 3] * back + side * kLaidAside * beside + kLaidUp * up);
  }
  /// Thread is drawn straight behind the jaws that it will be wound round, so that its slack does not bend before them;
  /// from another side each time.
  bool laid(Surgeon& op, Vec3d q) const {
    const bool away = dot(m_laid - q, q - m_stitch) > 0;
    const bool taut = tying::tension_from(op, m_hand, kSeenOf * m_free) > kTaut;
    return (away && taut) || tying::lead(op, m_hand, m_laid, pace::kTravel) || m_in_phase > kLongestLay;
  }
  Progress work(Surgeon& op) override {
    tying::watch(op);
    if (held_of_suture(op.model(), op.state(), std::size_t(m_hand)) == 0) return fail("the jaws lost the thread");
    op.want(op.arm(m_around).tip);
    op.want(op.arm(m_hand).tip);
    const Vec3d q = tying::held_thread(op, m_hand);
    if (m_phase == kLay) {
      turn_swage(op, m_stitch - q);
      if (laid(op, q)) go(kStand);
      return Progress::working;
    }
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
      if (tying::lead(op, m_hand, m_centre + m_now * m_from, pace::kTravel)) go(kTurn);
      return Progress::working;
    }
    turn_swage(op, m_centre - q);
    const double taut = tying::tension_from(op, m_hand, kSeenOf * m_free);
    if (taut > m_pull) m_now = std::max(kLeast, m_now - kTighter * sim::kTick);
    if (taut < 0.5 * m_pull) m_now = std::min(m_radius, m_now + kWider * sim::kTick);
    if (taut < 4 * m_pull) m_angle += kPace / std::max(0.01, m_now) * sim::kTick;
    const Vec3d round = m_centre + m_now * (portable::cos(m_angle) * m_from + portable::sin(m_angle) * m_to);
    tying::lead(op, m_hand, before_jaws(op, tying::above_tissue(op, m_hand, round)), 2 * pace::kTravel);
    // what lies round jaws loosely may detach over their tip, and then it is wound again; counted from the needle
    const double wound = -double(m_sense) * wraps_around(op.model(), op.state(), m_around);
    if (wound > m_turns + kSpare) return Progress::done;
    return m_angle > portable::two_pi * (m_turns + kMostMore) ? fail("the turns slip off the jaws") : Progress::working;
  }
  /// Further ahead where this shaft would cross those jaws.
  Vec3d before_jaws(const Surgeon& op, Vec3d at) const {
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
  bool turn_swage(Surgeon& op, Vec3d towards) const {
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
  Vec3d m_stitch, m_laid, m_stand, m_axis, m_centre, m_from, m_to;
};

}  // namespace

const SkillKind kWrap{
    "wrap",
    "wind the thread round the other instrument",
    {hand_parameter("the hand that holds needle or thread"),
     {"around", ArgumentKind::hand, "the hand whose jaws are wound round"},
     number_parameter("turns", "number of turns; default 1", 0.25, 4),
     word_parameter("way", "sense of the screw along those jaws; default right", {"right", "left"}),
     number_parameter("pull_N", "the circle shrinks while the tension is above this; default 0.3", 0.01, 10)},
    30,
    "Winds the thread round the other hand's closed jaws, which do not move.",
    &tying::lacks_thread,
    &making<Wrap>};

}  // namespace trocar::training
