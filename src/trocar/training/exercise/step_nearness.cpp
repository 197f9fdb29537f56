#include <algorithm>

#include <trocar/core/text.hpp>
#include <trocar/training/exercise/step_nearness.hpp>

namespace trocar::training {
namespace {

constexpr double kShownHold = 0.4;  // [s] shorter ones are over before they are read

double mean_share(const std::vector<Nearness>& rows) {
  double sum = 0;
  for (const Nearness& row : rows) sum += row.share;
  return rows.empty() ? 0 : sum / double(rows.size());
}

/// Of several acts that count, the one that is nearest.
std::vector<Nearness> of_act(const Act& act, const Snapshot& snapshot, const Names& names) {
  std::vector<Nearness> best;
  double most = -1;
  for (const Cause& cause : act.causes()) {
    std::vector<Nearness> rows = nearness(cause.while_true, snapshot, names);
    if (mean_share(rows) <= most) continue;
    most = mean_share(rows);
    best = std::move(rows);
  }
  return best;
}

}  // namespace

std::vector<Nearness> nearness_of(const Rules& rules, int step, const Snapshot& snapshot) {
  if (step < 0 || step >= int(rules.steps().size())) return {};
  const StepRule& rule = rules.steps()[size_t(step)];
  const bool holds = rule.when.there() && rule.done_for.needs >= kShownHold;
  std::vector<Nearness> rows =
      rule.when.there() ? nearness(rule.when, snapshot, rules.names()) : of_act(rule.on, snapshot, rules.names());
  rows = in_short(std::move(rows), holds ? kMostRows - 1 : kMostRows);
  if (holds && !rows.empty())
    rows.push_back(counted(tr("Hold"), std::min(rule.done_for.held, rule.done_for.needs), rule.done_for.needs, "s"));
  return rows;
}

}  // namespace trocar::training
