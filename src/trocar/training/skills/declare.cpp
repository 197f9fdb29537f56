#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// The key, held for as long as a finger does.
class Declare final : public Skill {
 public:
  Declare(const sim::Model&, const SkillArgs&) {}

 private:
  Progress work(Surgeon& op) override {
    constexpr double kHeld = 0.2;  // [s]
    op.declare();
    return m_in_phase > kHeld ? Progress::done : Progress::working;
  }
};

}  // namespace

const SkillKind kDeclare{
    "declare", "declare it",    {}, 5, "Declares, with the trainee's key, that the view is complete.",
    nothing,   &making<Declare>};

}  // namespace trocar::training
