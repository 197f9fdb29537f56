#include <trocar/core/json.hpp>
#include <trocar/training/metrics/known.hpp>
#include <trocar/training/metrics/study.hpp>

namespace trocar::training {
namespace {

Json spread_json(const Spread& s) {
  return {{"count", s.count},          {"min", known(s.least)}, {"q1", known(s.lower)},
          {"median", known(s.median)}, {"q3", known(s.upper)},  {"max", known(s.most)}};
}

Json ranged_json(const Ranged& r) {
  return {{"value", known(r.value)}, {"low", known(r.low)}, {"high", known(r.high)}};
}

Json metric_json(const Study& study, const MetricStudy& m) {
  Json j{{"key", m.column->key}, {"title", m.column->title}, {"unit", m.column->unit}};
  j["spread"] = spread_json(m.all);
  j["by_person"] = Json::object();
  for (std::size_t p = 0; p < study.persons.size(); ++p) {
    j["by_person"][study.persons[p]] = spread_json(m.by_person[p]);
    j["by_person"][study.persons[p]]["rho"] = known(m.person_rho[p]);
  }
  j["by_repetition"] = Json::array();
  for (const Spread& s : m.by_repetition) j["by_repetition"].push_back(spread_json(s));
  j["trend"] = {{"slope_per_repetition", ranged_json(m.trend.slope)},
                {"spearman_pooled", ranged_json(m.trend.pooled)},
                {"spearman_within", ranged_json(m.trend.within)}};
  return j;
}

}  // namespace

std::string study_json(const Study& study) {
  Json j{{"persons", study.persons},
         {"ranges", "low and high: the range of the figure when each person in turn is left out"},
         {"metrics", Json::array()},
         {"attempts", Json::array()}};
  for (const MetricStudy& m : study.metrics)
    if (m.all.count > 0) j["metrics"].push_back(metric_json(study, m));
  for (const StudyAttempt& a : study.attempts) {
    Json attempt{{"person", a.person}, {"trial", a.trial}, {"repetition", a.repetition}};
    attempt["metrics"] = Json::parse(metrics_json(a.metrics));
    j["attempts"].push_back(attempt);
  }
  return j.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace trocar::training
