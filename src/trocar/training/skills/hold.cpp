#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Hands and camera stay where they are.
class Wait final : public Skill {
 public:
  Wait(const sim::Model&, const Given& given) : m_time(given.number("for_s", 1e9)) {}

 private:
  Progress work(Operator&) override { return m_in_phase > m_time ? Progress::done : Progress::working; }
  double m_time;
};

}  // namespace

const SkillKind kHold{"hold",
                      "wait",
                      {number_parameter("for_s", "so long; none: until its \"until\"", 0, 600)},
                      60,
                      "Keeps hands and camera where they are, for a time or until something is so.",
                      nothing,
                      &making<Wait>};

}  // namespace trocar::training
