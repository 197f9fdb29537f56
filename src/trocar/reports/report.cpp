#include <algorithm>

#include <trocar/attempt/attempt_log.hpp>
#include <trocar/attempt/interrupt.hpp>
#include <trocar/attempt/sources.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/log.hpp>
#include <trocar/pictures/headless.hpp>
#include <trocar/reports/report.hpp>
#include <trocar/training/store/json_fields.hpp>

namespace trocar::reports {

using training::Attempt;
using training::AttemptMode;
using training::AttemptState;

std::optional<double> number_in(const Json& result, const std::string& pointer) {
  const Json::json_pointer at(pointer);
  if (!result.contains(at) || !result[at].is_number()) return std::nullopt;
  return result[at].get<double>();
}

Report gather(const training::Store* store, Attempt attempt) {
  Report r;
  Json result = training::json_in(attempt.result);
  if (result.is_object()) r.result = std::move(result);
  if (r.result.contains("failure")) r.result.erase("assessment");  // an older result may hold one
  if (!attempt.trace.empty()) try {
      r.trace = training::trace_from_bytes(attempt.trace, "the attempt's motion");
    } catch (const core::BadInput& bad) {
      core::log::warn("{}", bad.what());
    }
  if (store) {
    for (Attempt& a : store->list({.trainee = attempt.trainee, .exercise = attempt.exercise}))
      if (a.state == AttemptState::finished && a.mode == attempt.mode && a.number <= attempt.number)
        r.history.push_back(std::move(a));
    for (Attempt& a :
         store->list({.exercise = attempt.exercise, .seed = attempt.seed, .mode = AttemptMode::demonstration}))
      if (a.state == AttemptState::finished && a.input == "demo" && a.uuid != attempt.uuid) r.scripted = std::move(a);
  }
  r.attempt = std::move(attempt);
  return r;
}

Attempt demonstrate(training::Store& store, const std::string& exercise, std::uint64_t seed) {
  const std::unique_ptr<attempt::Lesson> lesson = attempt::load_lesson(exercise, seed);
  const std::unique_ptr<attempt::InputSource> source = lesson->surgeon();
  core::log::info("the demonstration of {} runs: this takes a while", exercise);
  attempt::Session session(*lesson);
  attempt::AttemptPlan plan;
  plan.input = "demo";
  plan.mode = AttemptMode::demonstration;
  plan.record = false;
  attempt::AttemptLog log(&store, session, plan);
  pictures::run_headless(session, *source, {});
  Json result = session.result(false);
  result["input"] = "demo";
  result.update(source->describe());
  log.end(result, attempt::interrupted() ? AttemptState::aborted : AttemptState::finished);
  return log.attempt();
}

}  // namespace trocar::reports
