#include "start/past.hpp"

#include <algorithm>
#include <ctime>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>

namespace trocar::app {
namespace {

constexpr int kMostAttempts = 2000;
constexpr double kShortest = 10;  // [s] of an attempt that was left early and is listed all the same

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
  return {a.number, a.exercise, a.title,   name_of(a.mode), name_of(a.state), day_and_time(a.started),
          a.score,  a.passed,   a.seconds, a.recording};
}

bool was_left(const PastAttempt& a) { return a.state == "aborted" || a.state == "interrupted"; }

}  // namespace

bool is_reserved_name(const std::string& name) {
  // "scripted surgeon": demonstrations of version 0.1.0's development
  return name == kNameless || name == "demonstration" || name == "replay" || name == "scripted surgeon";
}

Past read_past(const training::Store* store, const std::string& person) {
  Past past;
  if (!store) return past;
  past.notices = store->notices();
  try {
    for (const std::string& name : store->trainees())
      if (!name.empty() && !is_reserved_name(name)) past.people.push_back(name);
    training::AttemptFilter filter;
    filter.trainee = person.empty() ? kNameless : person;
    filter.limit = kMostAttempts;
    for (const training::Attempt& a : store->list(filter)) past.attempts.push_back(past_attempt(a));
    std::reverse(past.attempts.begin(), past.attempts.end());
  } catch (const core::EnvironmentLacks& lacks) {
    past.notices.emplace_back(lacks.what());
  }
  past.standings = standings_of(past.attempts);
  return past;
}

bool worth_listing(const PastAttempt& a) { return !was_left(a) || a.seconds >= kShortest; }

std::string result_of(const PastAttempt& a) {
  if (a.state == "running") return tr("Not ended");
  if (a.state == "not assessed") return tr("Not assessed: the simulation failed");
  if (a.mode == "familiarisation") return tr("Familiarisation");
  if (a.mode == "demonstration") return tr("Demonstration");
  if (a.mode == "free practice" || (!a.score && !was_left(a))) return tr("Free practice");
  if (a.state == "aborted") return tr("Ended early");
  if (a.state == "interrupted") return tr("Interrupted");
  return a.passed.value_or(false) ? tr("{:.0f} of 100, passed", *a.score) : tr("{:.0f} of 100, not passed", *a.score);
}

Standings standings_of(const std::vector<PastAttempt>& attempts) {
  Standings standings;
  for (const PastAttempt& a : attempts) {  // newest first
    if (a.mode != "assessed" || !a.score || was_left(a)) continue;
    Standing& s = standings[a.exercise];
    ++s.attempts;
    if (!s.last) s.last = a.score;
    s.best = std::max(s.best.value_or(0), *a.score);
    s.passed = s.passed || a.passed.value_or(false);
  }
  return standings;
}

}  // namespace trocar::app
