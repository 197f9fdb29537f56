#include <trocar/training/observe/bleeder.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>
#include <trocar/training/skills/vessel_carrier.hpp>

namespace trocar::training {
namespace {

/// What carries the artery that bleeds between bipolar jaws, where it bleeds: held, coagulated until it is sealed, let
/// go. Who does not get hold of it draws back and comes again a little deeper.
class CoagulateVessel final : public Skill {
 public:
  CoagulateVessel(const sim::Model&, const Given& given)
      : m_hand(given.hand()),
        m_longest(given.number("for_s", 4)),
        m_share(given.number("inside_share", 0.75)),
        m_closed(given.number("to", 0.95)) {}

 private:
  enum Phase { kReach, kEnter, kPinch, kPress, kOpen, kLeave };

  void start(Operator&, int tries) override {
    m_tries = tries;
    m_lost = "the vessel is not sealed";
    m_sealed_for = 0;
  }

  Progress work(Operator& op) override {
    op.want(op.arm(m_hand).tip);
    op.want(bleeding(op));
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

  Progress reach(Operator& op) {
    m_carrier = carrier_at(op, bleeder(op).vessel, bleeder(op).s);
    if (op.arms().grip(m_hand, 0, 0.5) && aim(op, reach::kBefore, pace::kTravel)) go(kEnter);
    if (m_in_phase > 15) give_up("it did not get there");
    return Progress::working;
  }

  Progress pinch(Operator& op) {
    constexpr double kFelt = 1.2;  // [s] until the jaws have closed on what they hold
    if (!op.arms().grip(m_hand, m_closed, 0.8) || m_in_phase < kFelt) return Progress::working;
    if (op.tool_state(m_hand).holds > 0) return go(kPress), Progress::working;
    give_up("the jaws have not taken it");
    return Progress::working;
  }

  Progress press(Operator& op) {
    constexpr double kSpare = 0.2;  // [s] after it has sealed
    m_sealed_for += bleeder_sealed(op.model(), op.state()) ? sim::kTick : 0;
    op.arm(m_hand).coagulating = m_in_phase < m_longest && m_sealed_for < kSpare;
    if (!op.arm(m_hand).coagulating) go(kOpen);
    return Progress::working;
  }

  Progress leave(Operator& op) {
    constexpr double kAway = 0.025;  // [m]
    Arms::Arm& arm = op.arm(m_hand);
    const bool away = op.arms().move(m_hand, m_carrier.place + kAway * normalised(arm.port - arm.tip), pace::kCareful);
    if (!away && m_in_phase < 4) return Progress::working;
    return bleeder_sealed(op.model(), op.state()) ? Progress::done : fail(m_lost);
  }

  void give_up(const char* why) {
    m_lost = why;
    go(kOpen);
  }

  /// To where the carrier lay before the jaws touched it.
  bool aim(Operator& op, double back, double speed) {
    constexpr double kDeeper = 0.0015;  // [m] with every failure
    const double inside = m_share * op.tool(m_hand).jaw_length - kDeeper * double(m_tries % 4);
    return op.aim(m_hand, m_carrier.place, m_carrier.along, inside, back, speed);
  }

  static const sim::Bleeder& bleeder(Operator& op) { return op.model().vessels.bleeder; }
  static Vec3d bleeding(Operator& op) { return op.vessel_spot(bleeder(op).vessel, bleeder(op).s).place; }

  int m_hand;
  double m_longest, m_share, m_closed;
  int m_tries = 0;
  double m_sealed_for = 0;  ///< [s]
  VesselCarrier m_carrier;
  const char* m_lost = "";
};

std::string lacks(const sim::Model& model, const Given& given) {
  if (!model.energy.there) return "there is no current";
  if (model.vessels.bleeder.vessel < 0) return "no vessel opens by itself";
  return lacks_tool(model, given.hand(), &interactions::Abilities::bipolar);
}

}  // namespace

const SkillKind kCoagulateVessel{
    "coagulate_vessel",
    "coagulate the place that bleeds",
    {hand_parameter("that has bipolar forceps"), number_parameter("for_s", "the pedal is pressed at most; 4", 0, 60),
     number_parameter("inside_share", "of the jaws' length: how far from their hinge the vessel shall lie; 0.75", 0, 1),
     number_parameter("to", "how far the handle closes; 0.95", 0, 1)},
    60,
    "Takes what carries the artery that bleeds between bipolar jaws, presses the blue pedal until it is sealed, opens, "
    "draws back.",
    lacks,
    &making<CoagulateVessel>};

}  // namespace trocar::training
