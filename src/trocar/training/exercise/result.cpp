// What is said of an attempt, as one JSON object.

#include <trocar/core/json.hpp>
#include <trocar/training/exercise/monitor.hpp>

namespace trocar::training {
namespace {

Json place_mm(Vec3d p) { return {p.x * 1000, p.y * 1000, p.z * 1000}; }

Json score_json(const Exercise& e, const Score& s) {
  const double shares = e.quality_share + e.time_share;
  Json j{{"scored", s.scored}};
  if (s.scored) j["total"] = s.total;
  j["quality"] = s.quality;
  j["time"] = s.time;
  j["motion"] = nullptr;
  j["penalties"] = s.penalties;
  j["points"] = {{"quality", 100 * e.quality_share / shares * s.quality},
                 {"time", 100 * e.time_share / shares * s.time}};
  j["points_at_most"] = {{"quality", 100 * e.quality_share / shares}, {"time", 100 * e.time_share / shares}};
  j["failed_by_error"] = s.failed;
  j["pass_mark"] = e.pass_mark;
  j["note"] = s.scored ? "motion component left out: no reference group yet"
                       : "familiarisation: steps and errors are reported without a score";
  return j;
}

Json step_json(const StepStatus& s) {
  Json j{{"name", s.name}, {"step", s.task}};
  if (!s.side.empty()) j["side"] = s.side;
  j["done"] = s.done;
  if (s.missed) j["missed"] = true;
  if (s.optional) j["optional"] = true;
  if (s.done || s.missed) j["at_s"] = s.at;
  return j;
}

Json error_json(const ErrorMade& e) {
  Json j{{"code", e.code}, {"name", e.name}, {"meaning", e.meaning}};
  if (!e.detail.empty()) j["detail"] = e.detail;
  if (!e.hint.empty()) j["hint"] = e.hint;
  if (!e.side.empty()) j["side"] = e.side;
  j["points"] = e.points;
  j["fail"] = e.fail;
  j["at_s"] = e.at;
  j["place_mm"] = place_mm(e.where);
  return j;
}

Json limits_json(const Limits& limits) {
  Json j = Json::object();
  for (const Limit& l : limits) {
    Json& t = j[l.name];
    if (l.is_range)
      t = {{"from", l.low}, {"to", l.high}};
    else
      t = {{"value", l.low}};
    t["source"] = l.source;
  }
  return j;
}

/// Titles of the sets' elements by their names, for people: "target_6" is "disc 6".
Json elements_json(const Sets& sets) {
  Json j = Json::object();
  for (const Set& set : sets)
    for (const Element& e : set.elements)
      if (!e.title.empty() && !j.contains(e.name)) j[e.name] = e.title;
  return j;
}

}  // namespace

std::string Monitor::result_json() const {
  const Score s = score();
  Json j;
  j["exercise"] = m_exercise->name;
  j["mode"] = m_board->mode() == Mode::assessed ? "assessed" : "familiarisation";
  j["finished"] = finished();
  j["passed"] = s.scored ? Json(s.passed) : Json(nullptr);
  j["score"] = score_json(*m_exercise, s);
  j["exercise_seconds"] = m_seconds;
  j["steps"] = Json::array();
  for (const StepStatus& step : steps()) j["steps"].push_back(step_json(step));
  j["errors"] = Json::array();
  for (const ErrorMade& e : errors()) j["errors"].push_back(error_json(e));
  m_rules->tell(j);
  j["elements"] = elements_json(m_rules->names().sets());
  if (!m_anatomy.empty()) j["anatomy"] = {{"variant", m_anatomy}, {"title", m_anatomy_title}};
  j["tools"] = Json::array();
  for (const ToolMetrics& t : m_tools)
    j["tools"].push_back({{"name", t.name},
                          {"path_m", t.path},
                          {"max_pull_N", t.max_pull},
                          {"max_at_trocar_N", t.max_on_wall},
                          {"max_by_hand_N", t.max_by_hand}});
  j["thresholds"] = limits_json(m_rules->names().limits());
  j["not_assessed"] = Json::array();
  for (const LaterError& l : m_exercise->later)
    j["not_assessed"].push_back({{"code", l.code}, {"name", l.name}, {"needs", l.needs}});
  return j.dump();
}

}  // namespace trocar::training
