#include <trocar/training/observe/hands.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// The pool through a suction-irrigator, where it stands deepest, until hardly anything is left.
class SuckDry final : public Skill {
 public:
  SuckDry(const sim::Model& model, const SkillArgs& args)
      : m_hand(args.hand()), m_place(model, args), m_left(args.number("left_mL", 0.5e-6)) {}

 private:
  Progress work(Surgeon& op) override {
    constexpr double kTouches = 1;  // [N]
    Arms::Arm& arm = op.arm(m_hand);
    const std::optional<Vec3d> pool = op.deepest_pool(m_hand);
    op.want(arm.tip);
    op.want(pool ? *pool : m_place.point(op, m_hand));
    const double left = fluids::kM3PerPicolitre * double(at(op.state().fluids.ledger, fluids::Place::kPool).total());
    const bool pushes = norm(op.tool_state(m_hand).contact_force) > kTouches;
    arm.sucking = pool && left >= m_left && !pushes && m_in_phase < 40;
    if (!arm.sucking) return Progress::done;
    op.arms().move(m_hand, *pool, pace::kCareful);
    return Progress::working;
  }

  int m_hand;
  Place m_place;
  double m_left;
};

std::string lacks_suction(const sim::Model& model, const SkillArgs& args) {
  if (!model.wet.there) return "the scene has no fluids";
  return lacks_tool(model, args.hand(), &interactions::Abilities::irrigate);
}

}  // namespace

const SkillKind kSuckDry{
    "suck_dry",
    "suck the pooled fluid",
    std::vector<Parameter>{hand_parameter("the hand with the suction-irrigator"),
                           number_parameter("left_mL", "volume that may remain; default 0.5", 0, 1000)} +
        place_parameters(),
    60,
    "Sucks at the deepest place of the pool that can be reached, until hardly anything is left. Looks at the place "
    "when no pool covers it.",
    lacks_suction,
    &making<SuckDry>};

}  // namespace trocar::training
