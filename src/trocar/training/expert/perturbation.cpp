#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <trocar/core/random.hpp>
#include <trocar/training/expert/perturbation.hpp>

namespace trocar::training {
namespace {

/// How far a parameter may be from what is written: a share of it, but at least so much.
struct Play {
  std::string_view parameter;
  double share, least;
};

// Our choice: about what two surgeons differ by. Lengths [m], forces [N].
constexpr std::array<Play, 9> kPlays{{{"by_mm", 0.3, 0.001},
                                      {"deep_mm", 0.2, 0},
                                      {"back_mm", 0.3, 0},
                                      {"above_mm", 0.15, 0},
                                      {"from_mm", 0.15, 0},
                                      {"pull_N", 0.25, 0},
                                      {"x_mm", 0, 0.005},
                                      {"y_mm", 0, 0.005},
                                      {"z_mm", 0, 0.005}}};
constexpr double kTremor = 0.0001;  // [m] rms; our estimate: of a steady hand

const Play* play_of(const Parameter& parameter) {
  for (const Play& play : kPlays)
    if (play.parameter == parameter.name && parameter.kind == ArgumentKind::number) return &play;
  return nullptr;
}

void vary(PlanTask& task, core::Random& random) {
  for (size_t i = 0; i < task.kind->parameters.size(); ++i) {
    const Play* play = play_of(task.kind->parameters[i]);
    Argument& argument = task.arguments[i];
    if (!play || !argument.given) continue;
    const double most = std::max(play->share * std::fabs(argument.low), play->least);
    argument.low += random.uniform(-most, most);
    argument.high = argument.low;
  }
  for (PlanTask& beside : task.meanwhile) vary(beside, random);
}

}  // namespace

PlanTask perturbed(const PlanTask& task, int perturbation) {
  PlanTask other = task;
  core::Random random{std::uint64_t(perturbation)};
  if (perturbation != 0) vary(other, random);
  return other;
}

Tremor perturbed_tremor(int perturbation) { return {perturbation == 0 ? 0 : kTremor, std::uint64_t(perturbation)}; }

}  // namespace trocar::training
