#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Hands and camera stay where they are.
class Wait final : public Skill {
 public:
  Wait(const sim::Model&, const SkillArgs& args) : m_time(args.number("for_s", 1e9)) {}

 private:
  Progress work(Surgeon&) override { return m_in_phase > m_time ? Progress::done : Progress::working; }
  double m_time;
};

}  // namespace

const SkillKind kHold{"hold",
                      "wait",
                      {number_parameter("for_s", "time; without it until the condition `until`", 0, 600)},
                      60,
                      "Keeps hands and camera in place, for a time or until a condition holds.",
                      nothing,
                      &making<Wait>};

}  // namespace trocar::training
