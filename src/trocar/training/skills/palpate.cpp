#include <algorithm>
#include <array>

#include <trocar/training/observe/hands.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// A blunt tip onto the tissue over a vessel, pressed no harder than it takes, held still; then it is declared with
/// each beat that the finger feels, so many times; and back.
class Palpate final : public Skill {
 public:
  Palpate(const sim::Model& model, const SkillArgs& args)
      : m_hand(args.hand()),
        m_vessel(args("vessel").index),
        m_share(args.number("share", 0.5)),
        m_press(args.number("press_N", 0.4)),
        m_taps(int(args.number("taps", 1))) {
    static_cast<void>(model);
  }

 private:
  enum Phase { kReach, kPress, kFeel, kTap, kLeave };
  static constexpr int kBeats = 1500;  ///< ticks of force that are remembered: more than a beat

  void start(Surgeon& op, int tries) override {
    Skill::start(op, tries);
    m_said = 0;
    m_filled = 0;
    m_low = false;
    m_since_tap = 1;
  }

  Progress work(Surgeon& op) override {
    constexpr double kOver = 0.015, kSettles = 0.7, kStill = 2.4, kTooMuch = 1.5, kLongest = 12,
                     kPressing = 8;  // [m]; [s]
    Arms::Arm& arm = op.arm(m_hand);
    const Vec3d at = op.vessel_spot(m_vessel, m_share).place, in = normalised(at - arm.port);
    op.want(arm.tip);
    op.want(at);
    const double force = norm(op.tool_state(m_hand).contact_force);
    switch (m_phase) {
      case kReach:
        if (op.arms().move(m_hand, at - kOver * in, pace::kTravel)) go(kPress);
        return m_in_phase > kLongest ? fail("the instrument did not reach the target") : Progress::working;
      case kPress:
        press(op, in, force);
        if (force > m_press) go(kFeel);
        return m_in_phase > kPressing ? fail("touches nothing") : Progress::working;
      case kFeel:
        if (m_in_phase > kSettles)
          remember(force);
        else if (force > kTooMuch * m_press)
          arm.tip -= pace::kTrack * sim::kTick * in;
        if (m_in_phase > kStill) go(kTap);
        return Progress::working;
      case kTap:
        remember(force);
        return tap(op);
      default:
        return op.arms().move_to_depth(m_hand, reach::kIdle, pace::kTravel) ? Progress::done : Progress::working;
    }
  }

  /// One tick more of pressing, as slowly as tissue is felt.
  void press(Surgeon& op, Vec3d in, double force) {
    constexpr double kTouched = 0.02, kInTheAir = 0.01;  // [N] [m/s]
    Arms::Arm& arm = op.arm(m_hand);
    arm.tip += (force > kTouched ? pace::kTrack : kInTheAir) * sim::kTick * in;
    arm.moving = true;
  }

  /// A finger is too slow for the tremor of the hand that it belongs to.
  void remember(double force) {
    constexpr double kSlow = 0.05;  // [s]
    m_felt = m_filled == 0 ? force : m_felt + sim::kTick / kSlow * (force - m_felt);
    m_force[size_t(m_filled % kBeats)] = m_felt;
    ++m_filled;
  }

  /// Declares when the force rises above its middle, once a beat.
  Progress tap(Surgeon& op) {
    constexpr double kHeld = 0.08, kQuickest = 0.4, kNoBeat = 3, kLeast = 0.002;  // [s]; [N]
    const auto count = std::min(m_filled, kBeats);
    const auto [least, most] = std::minmax_element(m_force.begin(), m_force.begin() + count);
    const double middle = 0.5 * (*least + *most), swing = *most - *least;
    m_since_tap += sim::kTick;
    if (m_since_tap < kHeld) op.declare();
    if (m_felt < middle - 0.2 * swing) m_low = true;
    if (m_low && m_felt > middle && swing > kLeast && m_since_tap > kQuickest) {
      if (m_said == m_taps) {
        go(kLeave);
        return Progress::working;
      }
      m_low = false;
      m_since_tap = 0;
      m_steady = 0;
      ++m_said;
    }
    m_steady += sim::kTick;
    if (m_steady > kNoBeat) return fail("feels no pulse");
    return Progress::working;
  }

  int m_hand, m_vessel;
  double m_share, m_press;
  int m_taps, m_said = 0, m_filled = 0;
  bool m_low = false;
  double m_felt = 0;                     ///< [N]
  double m_since_tap = 1;                ///< [s]
  std::array<double, kBeats> m_force{};  ///< [N]
};

std::string lacks_vessel(const sim::Model& model, const SkillArgs& args) {
  if (!model.vessels.there()) return "the scene has no vessels";
  return args("vessel").index < 0 ? "there is no such vessel" : std::string();
}

}  // namespace

const SkillKind kPalpate{
    "palpate",
    "feel the pulse",
    {hand_parameter("the hand whose instrument presses"),
     {"vessel", ArgumentKind::vessel, "the vessel to feel"},
     number_parameter("share", "place along it, 0 to 1; default 0.5", 0, 1),
     number_parameter("press_N", "pressing force; default 0.4", 0.01, 5),
     number_parameter("taps", "number of beats to declare; default 1", 1, 60)},
    60,
    "Presses on the tissue over an artery until its beats are felt, declares with each of them, and withdraws.",
    lacks_vessel,
    &making<Palpate>};

}  // namespace trocar::training
