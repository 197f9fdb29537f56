#include <fmt/format.h>

#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Lets go of what it holds and goes back to the trocar, where instruments are changed.
class PutDown final : public Skill {
 public:
  PutDown(const sim::Model&, const Given& given) : m_hand(given.hand()), m_least(given.number("least_s", 0)) {}

 private:
  Progress work(Operator& op) override {
    op.posture(m_hand).end();
    if (op.tool_state(m_hand).holds > 0 || op.arm(m_hand).handle > 0) {
      op.arms().grip(m_hand, 0, 0.4);
      return Progress::working;
    }
    const bool back = op.arms().move_to_depth(m_hand, reach::kIdle, 2 * pace::kTravel);
    return back && m_in_phase > m_least ? Progress::done : Progress::working;
  }
  int m_hand;
  double m_least;
};

/// Another instrument through the same trocar. It waits until the camera shows the trocar's inner end.
class Take final : public Skill {
 public:
  Take(const sim::Model& model, const Given& given)
      : m_hand(given.hand()),
        m_number(model.hands[size_t(m_hand)].find(given("instrument").word)),
        m_towards(model, given),
        m_watched(!given.says("watch", "no")) {}

 private:
  Progress work(Operator& op) override {
    Arms::Arm& arm = op.arm(m_hand);
    arm.instrument = m_number;
    const Vec3d to = m_towards.point(op, m_hand), inwards = normalised(to - arm.port);
    arm.tip = arm.port + reach::kIdle * inwards;
    if (m_watched) {
      op.want(arm.port + 0.055 * inwards);
      op.want(arm.port + reach::kBroughtIn * inwards);
    }
    const bool taken = op.tool_state(m_hand).instrument == m_number && op.camera().settled() && m_in_phase > 0.6;
    return taken ? Progress::done : Progress::working;
  }
  int m_hand, m_number;
  Place m_towards;
  bool m_watched;
};

/// From under the trocar to where it can work, the camera on its tip.
class BringIn final : public Skill {
 public:
  BringIn(const sim::Model& model, const Given& given)
      : m_hand(given.hand()), m_towards(model, given), m_watched(!given.says("watch", "no")) {}

 private:
  Progress work(Operator& op) override {
    const Arms::Arm& arm = op.arm(m_hand);
    const Vec3d inwards = normalised(m_towards.point(op, m_hand) - arm.port);
    if (m_watched) {
      op.want(arm.tip);
      op.want(arm.tip + 0.02 * inwards);
    }
    return op.arms().move_to_depth(m_hand, reach::kBroughtIn, 0.035) ? Progress::done : Progress::working;
  }
  int m_hand;
  Place m_towards;
  bool m_watched;
};

std::string lacks_instrument(const sim::Model& model, const Given& given) {
  const sim::HandModel& hand = model.hands[size_t(given.hand())];
  if (hand.find(given("instrument").word) < 0)
    return fmt::format("the rack at the trocar \"{}\" has no \"{}\"", hand.name, given("instrument").word);
  return Place::lacks(model, given);
}

Parameter watch() {
  return word_parameter("watch", "whether the camera shows the trocar's inner end meanwhile; as a rule", {"yes", "no"});
}

}  // namespace

const SkillKind kPutDown{"put_down",
                         "draw an instrument back",
                         {hand_parameter(), number_parameter("least_s", "so long at least", 0, 60)},
                         15,
                         "Opens the jaws and draws the instrument back to under its trocar.",
                         nothing,
                         &making<PutDown>};
const SkillKind kTake{
    "take",
    "change an instrument",
    std::vector<Parameter>{
        hand_parameter("whose trocar"), {"instrument", ArgumentKind::word, "of its rack, by name"}, watch()} +
        place_parameters(),
    15,
    "Takes another instrument and waits under the trocar, pointing at the place, until it is seen.",
    lacks_instrument,
    &making<Take>};
const SkillKind kBringIn{"bring_in",
                         "bring an instrument in",
                         std::vector<Parameter>{hand_parameter(), watch()} + place_parameters(),
                         15,
                         "Brings an instrument from under its trocar towards the place, the camera on its tip.",
                         Place::lacks,
                         &making<BringIn>};

}  // namespace trocar::training
