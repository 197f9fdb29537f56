#include <algorithm>

#include <trocar/core/error.hpp>
#include <trocar/core/log.hpp>
#include <trocar/training/store/standing.hpp>

namespace trocar::training {
namespace {

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

}  // namespace

Standing standing_of(std::vector<double> scores) {
  Standing s;
  s.scores = std::move(scores);
  if (s.scores.empty()) return s;
  s.last = s.scores.back();
  s.best = *std::max_element(s.scores.begin(), s.scores.end());
  s.median = median_of(s.scores);
  return s;
}

Standing read_standing(const Store& store, const std::string& trainee, const std::string& exercise, int most) {
  std::vector<double> scores;
  try {
    for (const Attempt& a :
         store.list({.trainee = trainee, .exercise = exercise, .mode = AttemptMode::assessed, .limit = most}))
      if (a.state == AttemptState::finished && a.score) scores.push_back(*a.score);
  } catch (const core::EnvironmentLacks& lacks) {
    core::log::warn("{}", lacks.what());
  }
  return standing_of(std::move(scores));
}

}  // namespace trocar::training
