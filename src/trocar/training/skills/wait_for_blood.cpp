#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Until blood shows somewhere.
class WaitForBlood final : public Skill {
 public:
  WaitForBlood(const sim::Model&, const SkillArgs& args) : m_least(args.number("least_s", 1)) {}

 private:
  Progress work(Surgeon& op) override {
    return op.state().opening_count > 0 && m_in_phase > m_least ? Progress::done : Progress::working;
  }
  double m_least;
};

std::string no_blood(const sim::Model& model, const SkillArgs&) {
  return model.vessels.there() ? "" : "the scene has no vessels";
}

}  // namespace

const SkillKind kWaitForBlood{"wait_for_blood",
                              "wait",
                              {number_parameter("least_s", "minimum time", 0, 600)},
                              120,
                              "Waits until a vessel has opened.",
                              no_blood,
                              &making<WaitForBlood>};

}  // namespace trocar::training
