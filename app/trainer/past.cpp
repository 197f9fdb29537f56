#include "trainer/past.hpp"

#include <algorithm>
#include <ctime>

#include <trocar/core/error.hpp>

namespace trocar::app {
namespace {

/// "2026-03-01T14:05:09Z" -> "2026-03-01 15:05" where clocks say so
std::string day_and_time(const std::string& utc) {
  std::tm parts{};
  if (!strptime(utc.c_str(), "%Y-%m-%dT%H:%M:%S", &parts)) return utc.substr(0, 16);
  const std::time_t when = timegm(&parts);
  localtime_r(&when, &parts);
  char out[32];
  return {out, std::strftime(out, sizeof out, "%Y-%m-%d %H:%M", &parts)};
}

PastAttempt past_attempt(const training::Attempt& a) {
  return {a.number, a.exercise, a.title,  name_of(a.mode), name_of(a.state), day_and_time(a.started),
          a.score,  a.passed,   a.seconds};
}

}  // namespace

Past read_past(const training::Store* store, const std::string& trainee) {
  Past past;
  if (!store) return past;
  past.notices = store->notices();
  try {
    past.trainees = store->trainees();
    training::AttemptFilter filter;
    filter.trainee = trainee.empty() ? "guest" : trainee;
    filter.limit = 50;
    for (const training::Attempt& a : store->list(filter)) past.attempts.push_back(past_attempt(a));
    std::reverse(past.attempts.begin(), past.attempts.end());
  } catch (const core::EnvironmentLacks& lacks) {
    past.notices.emplace_back(lacks.what());
  }
  return past;
}

}  // namespace trocar::app
