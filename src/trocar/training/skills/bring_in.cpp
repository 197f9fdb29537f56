#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// From under the trocar to where it can work, the camera on its tip.
class BringIn final : public Skill {
 public:
  BringIn(const sim::Model& model, const SkillArgs& args)
      : m_hand(args.hand()), m_towards(model, args), m_watched(!args.equals("watch", "no")) {}

 private:
  Progress work(Surgeon& op) override {
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

}  // namespace

const SkillKind kBringIn{"bring_in",
                         "bring an instrument in",
                         std::vector<Parameter>{hand_parameter(), watch_parameter()} + place_parameters(),
                         15,
                         "Brings an instrument from its port to the place, with the camera on its tip.",
                         Place::lacks,
                         &making<BringIn>};

}  // namespace trocar::training
