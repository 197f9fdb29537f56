#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <trocar/core/random.hpp>
#include <trocar/training/expert/ways.hpp>

namespace trocar::training {
namespace {

/// How far a parameter may be from what is written: a share of it, but at least so much.
struct Play {
  std::string_view parameter;
  double share, least;
};

// Ours: about what two surgeons differ by. Lengths [m], forces [N].
constexpr std::array<Play, 9> kPlays{{{"by_mm", 0.3, 0.001},
                                      {"deep_mm", 0.2, 0},
                                      {"back_mm", 0.3, 0},
                                      {"above_mm", 0.15, 0},
                                      {"from_mm", 0.15, 0},
                                      {"pull_N", 0.25, 0},
                                      {"x_mm", 0, 0.005},
                                      {"y_mm", 0, 0.005},
                                      {"z_mm", 0, 0.005}}};

const Play* play_of(const PlanTask& task, size_t i) {
  const Parameter& parameter = task.kind->parameters[i];
  if (parameter.kind != ArgumentKind::number || !task.arguments[i].given) return nullptr;
  for (const Play& play : kPlays)
    if (play.parameter == parameter.name) return &play;
  return nullptr;
}

/// Calls visit(argument, play) for all that may be otherwise, in the plan's order.
template <class Visit>
void each_free(std::vector<PlanTask>& tasks, Visit&& visit) {
  for (PlanTask& task : tasks) {
    for (size_t i = 0; i < task.kind->parameters.size(); ++i)
      if (const Play* play = play_of(task, i)) visit(task.arguments[i], *play);
    each_free(task.meanwhile, visit);
  }
}
template <class Visit>
void each_free(PlanPart& part, Visit&& visit) {
  for (PlanGoal& goal : part.goals) {
    each_free(goal.todo, visit);
    each_free(goal.if_failed, visit);
  }
}

}  // namespace

bool has_ways(PlanPart part) {
  bool has = false;
  each_free(part, [&has](Argument&, const Play&) { has = true; });
  return has;
}

void do_in_way(PlanPart& part, int way, std::uint64_t place) {
  if (way == 0) return;
  core::Random random(std::uint64_t(way) << 32 | place);
  each_free(part, [&random](Argument& argument, const Play& play) {
    const double most = std::max(play.share * std::fabs(argument.low), play.least);
    argument.low += random.uniform(-most, most);
    argument.high = argument.low;
  });
}

}  // namespace trocar::training
