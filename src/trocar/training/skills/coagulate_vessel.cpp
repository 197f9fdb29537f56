#include <algorithm>
#include <cmath>

#include <trocar/training/observe/bleeder.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>
#include <trocar/training/skills/vessel_carrier.hpp>

namespace trocar::training {
namespace {

/// What carries a vessel (as a rule the one that bleeds, where it bleeds) between bipolar jaws: held, coagulated until
/// it is sealed, let go. Who has taken what lies beside it, or nothing, draws back and comes again there, or a little
/// deeper.
class CoagulateVessel final : public Skill {
 public:
  CoagulateVessel(const sim::Model& model, const SkillArgs& args)
      : m_hand(args.hand()),
        m_vessel(args("vessel").given ? args("vessel").index : model.vessels.bleeder.vessel),
        m_s(args("vessel").given ? args.number("share", 0.5) : model.vessels.bleeder.s),
        m_longest(args.number("for_s", 4)),
        m_share(args.number("inside_share", 0.75)),
        m_closed(args.number("to", 0.95)) {}

 private:
  static constexpr double kMostShift = 0.010;  // [m]
  enum Phase { kReach, kEnter, kPinch, kPress, kOpen, kLeave };

  void start(Surgeon&, int tries) override {
    if (tries == 0) m_shift = m_missed = 0;
    m_lost = "the vessel is not sealed";
    m_sealed_for = 0;
    m_taken = 0;
    m_again = false;
  }

  Progress work(Surgeon& op) override {
    op.want(op.arm(m_hand).tip);
    op.want(place(op));
    switch (m_phase) {
      case kReach:
        return reach(op);
      case kEnter:
        if (aim(op, 0, pace::kCareful) || m_in_phase > 6) go(kPinch);
        return Progress::working;
      case kPinch:
        return pinch(op);
      case kPress:
        return press(op);
      case kOpen:
        if (op.arms().grip(m_hand, 0, 0.5)) go(kLeave);
        return Progress::working;
      default:
        return leave(op);
    }
  }

  Progress reach(Surgeon& op) {
    m_carrier = carrier_at(op, m_vessel, m_s);
    if (op.arms().grip(m_hand, 0, 0.5) && aim(op, reach::kBefore, pace::kTravel)) go(kEnter);
    if (m_in_phase > 15) give_up("the instrument did not reach the target");
    return Progress::working;
  }

  Progress pinch(Surgeon& op) {
    constexpr double kFelt = 1.2;  // [s] until the jaws have closed on what they hold
    if (!op.arms().grip(m_hand, m_closed, 0.8) || m_in_phase < kFelt) return Progress::working;
    if (op.tool_state(m_hand).holds == 0) {
      ++m_missed;
      return come_again("the jaws did not grasp it"), Progress::working;
    }
    const double beside = from_jaws(op);
    if (std::fabs(beside) <= 0.35 * op.tool(m_hand).jaw_width) return go(kPress), Progress::working;
    m_shift = std::clamp(m_shift + beside, -kMostShift, kMostShift);
    come_again("the jaws grasped tissue beside the target");
    return Progress::working;
  }

  /// How far along what is held the place lies from the jaws' middle.
  double from_jaws(Surgeon& op) const {
    constexpr double kAcross = 0.3;  // less, and the jaws lie along it
    const interactions::ToolShape shape = sim::shape_of(op.model(), op.state(), size_t(m_hand));
    const VesselCarrier now = carrier_at(op, m_vessel, m_s);
    const double across = dot(now.along, interactions::direction_from_jaw(shape, {0, 1, 0}));
    if (std::fabs(across) < kAcross) return 0;
    return interactions::to_jaw(shape, now.place).y / across;
  }

  Progress press(Surgeon& op) {
    constexpr double kSpare = 0.2;  // [s] after it has sealed
    m_sealed_for += sealed(op) ? sim::kTick : 0;
    op.arm(m_hand).coagulating = m_in_phase < m_longest && m_sealed_for < kSpare;
    if (!op.arm(m_hand).coagulating) go(kOpen);
    return Progress::working;
  }

  Progress leave(Surgeon& op) {
    constexpr double kAway = 0.025;  // [m]
    Arms::Arm& arm = op.arm(m_hand);
    const bool away = op.arms().move(m_hand, m_carrier.place + kAway * normalised(arm.port - arm.tip), pace::kCareful);
    if (!away && m_in_phase < 4) return Progress::working;
    if (m_again) return m_again = false, go(kReach), Progress::working;
    return sealed(op) ? Progress::done : fail(m_lost);
  }

  /// Opens and draws back a little; gives up after so many times.
  void come_again(const char* why) {
    constexpr int kMost = 4;
    m_again = ++m_taken < kMost;
    give_up(why);
  }
  void give_up(const char* why) {
    m_lost = why;
    go(kOpen);
  }

  /// To where the carrier lay before the jaws touched it, and as much further along it as they dragged it last time.
  bool aim(Surgeon& op, double back, double speed) {
    constexpr double kDeeper = 0.0015;  // [m] each time that they took nothing
    const double inside = m_share * op.tool(m_hand).jaw_length - kDeeper * double(m_missed % 4);
    return op.aim(m_hand, m_carrier.place + m_shift * m_carrier.along, m_carrier.along, inside, back, speed);
  }

  Vec3d place(Surgeon& op) const { return op.vessel_spot(m_vessel, m_s).place; }
  bool sealed(const Surgeon& op) const { return vessel_sealed(op.state(), m_vessel, m_s); }

  int m_hand, m_vessel;
  double m_s;  ///< 0 to 1 along it
  double m_longest, m_share, m_closed;
  int m_taken = 0;  ///< how often something else, or nothing
  bool m_again = false;
  int m_missed = 0;         ///< how often the jaws took nothing
  double m_shift = 0;       ///< learnt from what lay beside the place [m]
  double m_sealed_for = 0;  ///< [s]
  VesselCarrier m_carrier;
  const char* m_lost = "";
};

std::string coagulate_vessel_lacks(const sim::Model& model, const SkillArgs& args) {
  if (!model.energy.there) return "the scene has no current";
  if (!args("vessel").given && model.vessels.bleeder.vessel < 0) return "the scene has no bleeder";
  return lacks_tool(model, args.hand(), &interactions::Abilities::bipolar);
}

}  // namespace

const SkillKind kCoagulateVessel{
    "coagulate_vessel",
    "coagulate the bleeding point",
    {hand_parameter("the hand with bipolar forceps"),
     number_parameter("for_s", "longest time with the pedal pressed; default 4", 0, 60),
     number_parameter("inside_share",
                      "distance of the vessel from the hinge, as a share of the jaws' length; default 0.75", 0, 1),
     number_parameter("to", "closing of the handle; default 0.95", 0, 1),
     {"vessel", ArgumentKind::vessel, "the vessel; without it the one that bleeds, where it bleeds", false},
     number_parameter("share", "place along that vessel; default 0.5", 0, 1)},
    60,
    "Takes the bleeding artery, or a named vessel, between bipolar jaws, presses the blue pedal until it is sealed, "
    "opens, withdraws.",
    coagulate_vessel_lacks,
    &making<CoagulateVessel>};

}  // namespace trocar::training
