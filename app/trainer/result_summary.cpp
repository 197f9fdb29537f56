#include "trainer/result_summary.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/attempt/hand_names.hpp>
#include <trocar/core/letters.hpp>
#include <trocar/core/text.hpp>

#include "trainer/feedback.hpp"

namespace trocar::app {
namespace {

using Verdict = ResultSummary::Verdict;

const Json& member(const Json& object, const char* key) {
  static const Json nothing;
  return object.is_object() && object.contains(key) ? object[key] : nothing;
}

double number(const Json& object, const char* key, double otherwise = 0) {
  const Json& value = member(object, key);
  return value.is_number() ? value.get<double>() : otherwise;
}

std::string text(const Json& object, const char* key) {
  const Json& value = member(object, key);
  return value.is_string() ? value.get<std::string>() : std::string();
}

/// One decimal, none where it is 0: "41.2", "60".
std::string points(double value) {
  const double rounded = std::round(10 * value) / 10;
  return rounded == std::round(rounded) ? fmt::format("{:.0f}", rounded == 0 ? 0.0 : rounded)
                                        : fmt::format("{:.1f}", rounded);
}

Verdict verdict_of(const Json& r) {
  if (r.contains("failure")) return Verdict::simulation_failed;
  const Json& passed = member(r, "passed");
  if (!passed.is_boolean()) return Verdict::no_score;
  if (r.contains("interrupted")) return Verdict::ended_early;
  return passed.get<bool>() ? Verdict::passed : Verdict::not_passed;
}

void add_part(const Json& score, const char* key, const char* name, ResultSummary& s) {
  const double got = number(member(score, "points"), key), most = number(member(score, "points_at_most"), key);
  if (most <= 0) return;
  s.parts.push_back({name, tr("{} of {} points", points(got), points(most)), std::clamp(got / most, 0.0, 1.0)});
}

void add_score(const Json& score, ResultSummary& s) {
  if (!score.is_object() || !score.contains("total")) return;
  s.pass_mark = number(score, "pass_mark", 80);
  s.score = tr("{} of 100 points (pass mark {})", points(number(score, "total")), points(s.pass_mark));
  add_part(score, "quality", tr("Quality"), s);
  add_part(score, "time", tr("Time bonus"), s);
  if (const double lost = number(score, "penalties"); lost > 0)
    s.parts.push_back({tr("Errors"), tr("-{} points", points(lost)), 0});
}

/// Errors of the same code are one line.
void add_costs(const Json& errors, bool scored, ResultSummary& s) {
  if (!errors.is_array()) return;
  struct Repeated {
    const Json* first;
    int count = 0;
    double points = 0;
  };
  std::vector<Repeated> kinds;
  for (const Json& e : errors) {
    const auto same = [&](const Repeated& k) { return text(*k.first, "code") == text(e, "code"); };
    auto known = std::find_if(kinds.begin(), kinds.end(), same);
    if (known == kinds.end()) known = kinds.insert(kinds.end(), Repeated{&e});
    ++known->count;
    known->points += number(e, "points");
  }
  std::stable_sort(kinds.begin(), kinds.end(),
                   [](const Repeated& a, const Repeated& b) { return a.points > b.points; });
  for (const Repeated& k : kinds) {
    const Json& e = *k.first;
    const std::string at = clock_text(number(e, "at_s"));
    ResultSummary::Cost cost;
    cost.text = core::with_capital(text(e, "meaning"));
    cost.when = k.count == 1 ? tr("at {}", at) : tr("{} times, first at {}", k.count, at);
    if (scored && k.points > 0) cost.points = tr("-{} points", points(k.points));
    if (const std::string hint = text(e, "hint"); !hint.empty()) cost.better = tr("Better: {}", hint);
    cost.lost = k.points;
    cost.fails = std::any_of(errors.begin(), errors.end(), [&](const Json& other) {
      return text(other, "code") == text(e, "code") && member(other, "fail") == true;
    });
    s.costs.push_back(std::move(cost));
  }
}

void add_steps(const Json& steps, ResultSummary& s) {
  if (!steps.is_array()) return;
  for (const Json& step : steps) s.steps.push_back({text(step, "name"), member(step, "done") == true});
}

void add_paths(const Json& metrics, ResultSummary& s) {
  if (const Json& hands = member(metrics, "hands"); hands.is_array())
    for (const Json& hand : hands)
      if (member(hand, "path_m").is_number())
        s.paths.push_back(tr("{}: {:.0f} mm", core::with_capital(attempt::in_words(text(hand, "name"))),
                             1000 * number(hand, "path_m")));
  const Json& camera = member(metrics, "camera");
  if (member(camera, "path_m").is_number())
    s.paths.push_back(tr("Endoscope: {:.0f} mm", 1000 * number(camera, "path_m")));
}

std::string earlier_in_words(const training::Standing& standing) {
  const std::size_t n = standing.scores.size();
  if (n < 2) return {};
  return tr("Previous {}, best {}, median {} points ({} attempts)", points(standing.scores[n - 2]),
            points(*standing.best), points(*standing.median), n);
}

/// The weakest thing first: what cost most, then what was not done, then how long it took.
std::string advice_of(const ResultSummary& s) {
  if (s.score.empty()) return {};
  if (!s.costs.empty() && (s.costs.front().lost > 0 || s.costs.front().fails)) {
    const ResultSummary::Cost& worst = s.costs.front();
    return worst.better.empty() ? tr("Avoid this error first: {}.", worst.text)
                                : tr("Avoid this error first: {}. {}", worst.text, worst.better);
  }
  const auto open = std::find_if(s.steps.begin(), s.steps.end(), [](const auto& step) { return !step.done; });
  if (open != s.steps.end()) return tr("Practise this step next: {}.", open->name);
  const auto slow = [](const ResultSummary::Part& p) { return p.name == tr("Time bonus") && p.share < 0.8; };
  if (std::any_of(s.parts.begin(), s.parts.end(), slow))
    return tr("All steps are completed. Work faster for more points of the time bonus.");
  return {};
}

}  // namespace

ResultSummary summarise(const Json& r, const training::Standing& standing) {
  ResultSummary s;
  s.verdict = verdict_of(r);
  s.failure = text(r, "failure");
  const Json& a = member(r, "assessment");
  add_score(member(a, "score"), s);
  add_costs(member(a, "errors"), !s.score.empty(), s);
  add_steps(member(a, "steps"), s);
  add_paths(member(r, "metrics"), s);
  const bool timed = member(r, "exercise_seconds").is_number();
  s.duration = tr("Duration {}", clock_text(number(r, timed ? "exercise_seconds" : "simulated_seconds")));
  s.standing = standing;
  if (!s.score.empty()) s.earlier = earlier_in_words(standing);
  s.advice = advice_of(s);
  return s;
}

std::string next_training(const std::vector<attempt::ExerciseEntry>& exercises, const std::string& name, bool passed) {
  const auto here = std::find_if(exercises.begin(), exercises.end(), [&](const auto& e) { return e.name == name; });
  if (here == exercises.end()) return {};
  if (!passed) return tr("Repeat this exercise until you reach the pass mark.");
  const auto next = here + 1;
  return next == exercises.end() ? std::string()
                                 : tr("Next exercise: {}", next->title.empty() ? next->name : next->title);
}

}  // namespace trocar::app
