#include <trocar/training/observe/hands.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// An electrode to a place until it touches, the blue pedal for a time, and back.
class Coagulate final : public Skill {
 public:
  Coagulate(const sim::Model& model, const SkillArgs& args)
      : m_hand(args.hand()), m_place(model, args), m_time(args.number("for_s", 1)) {}

 private:
  enum Phase { kReach, kPress, kLeave };

  Progress work(Surgeon& op) override {
    constexpr double kFar = 8, kTouch = 0.5;  // [s] further away is nothing here; a touch without current
    constexpr double kDeeper = 0.002;         // [m] tissue that is pushed gives way
    Arms::Arm& arm = op.arm(m_hand);
    const Vec3d at = m_place.point(op, m_hand), goal = at + kDeeper * normalised(at - arm.port);
    op.want(arm.tip);
    op.want(goal);
    if (m_phase == kReach) {
      const bool there = op.arms().move(m_hand, goal, pace::kCareful);
      if (there || norm(op.tool_state(m_hand).contact_force) > 0.05 || m_in_phase > kFar) go(kPress);
    } else if (m_phase == kPress) {
      arm.coagulating = m_in_phase < m_time;
      if (!arm.coagulating && m_in_phase > kTouch) go(kLeave);
    } else if (op.arms().move_to_depth(m_hand, reach::kIdle, pace::kTravel)) {
      return Progress::done;
    }
    return Progress::working;
  }

  int m_hand;
  Place m_place;
  double m_time;
};

std::string lacks_current(const sim::Model& model, const SkillArgs& args) {
  if (!model.energy.there) return "the scene has no current";
  if (std::string lack = lacks_tool(model, args.hand(), &interactions::Abilities::coagulate); !lack.empty())
    return lack;
  return Place::lacks(model, args);
}
}  // namespace

const SkillKind kCoagulate{
    "coagulate",
    "coagulate",
    std::vector<Parameter>{hand_parameter("the hand with a hook or bipolar forceps"),
                           number_parameter("for_s", "time with the pedal pressed; 0 only touches; default 1", 0, 60)} +
        place_parameters(),
    60,
    "Brings an electrode to a place until it touches, presses the blue pedal, and withdraws.",
    lacks_current,
    &making<Coagulate>};

}  // namespace trocar::training
