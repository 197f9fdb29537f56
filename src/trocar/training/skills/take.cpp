#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Another instrument through the same trocar. It waits until the camera shows the trocar's inner end.
class Take final : public Skill {
 public:
  Take(const sim::Model& model, const SkillArgs& args)
      : m_hand(args.hand()),
        m_number(model.hands[size_t(m_hand)].find(args("instrument").word)),
        m_towards(model, args),
        m_watched(!args.equals("watch", "no")) {}

 private:
  Progress work(Surgeon& op) override {
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

std::string lacks_instrument(const sim::Model& model, const SkillArgs& args) {
  const sim::HandModel& hand = model.hands[size_t(args.hand())];
  if (hand.find(args("instrument").word) < 0)
    return tr("the rack at the trocar \"{}\" has no \"{}\"", hand.name, args("instrument").word);
  return Place::lacks(model, args);
}

}  // namespace

const SkillKind kTake{"take",
                      "change an instrument",
                      std::vector<Parameter>{hand_parameter("the hand that takes it"),
                                             {"instrument", ArgumentKind::word, "name of an instrument in its rack"},
                                             watch_parameter()} +
                          place_parameters(),
                      15,
                      "Takes another instrument and waits at the port, pointing at the place, until it is in view.",
                      lacks_instrument,
                      &making<Take>};

}  // namespace trocar::training
