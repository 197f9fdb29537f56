#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/hash.hpp>
#include <trocar/core/text.hpp>
#include <trocar/reports/labels.hpp>
#include <trocar/reports/report_data.hpp>
#include <trocar/reports/report_metrics.hpp>
#include <trocar/reports/report_motion.hpp>
#include <trocar/reports/report_svg.hpp>
#include <trocar/sim/model/model.hpp>

namespace trocar::reports {

namespace fs = std::filesystem;

namespace {

double real_in(const Json& object, const char* key, double otherwise = 0) {
  return object.is_object() && object.contains(key) && object[key].is_number() ? object[key].get<double>() : otherwise;
}

bool true_in(const Json& object, const char* key) {
  return object.is_object() && object.contains(key) && object[key].is_boolean() && object[key].get<bool>();
}

std::string points(double p) { return fmt::format("{:.1f}", std::fabs(p) < 0.05 ? 0.0 : p); }

/// The title of a set's element as the exercise's file gives it: "Disc 6" for "target_6".
std::string element_title(const Report& r, const std::string& name) {
  const std::string title = text_in(part_of(part_of(r.result, "assessment"), "elements"), name.c_str());
  return in_plain_words(title.empty() ? name : title, true);
}

// --- what it was, and how it ended ---

struct Verdict {
  const char *kind, *word;
};

Verdict verdict_of(const Report& r) {
  switch (r.attempt.state) {
    case training::AttemptState::interrupted:
      return {"", tr("Interrupted")};
    case training::AttemptState::running:
      return {"", tr("Still running")};
    case training::AttemptState::aborted:
      return {"", tr("Ended early")};
    case training::AttemptState::finished:
    case training::AttemptState::not_assessed:
      break;
  }
  if (r.result.contains("failure")) return {"", tr("Not assessed: the simulation failed")};
  const Json& passed = part_of(r.result, "passed");
  if (!passed.is_boolean())
    return {"", r.attempt.mode == training::AttemptMode::familiarisation ? tr("Familiarisation")
                : r.attempt.mode == training::AttemptMode::demonstration ? tr("Demonstration")
                                                                         : tr("Practice")};
  return passed.get<bool>() ? Verdict{"passed", tr("Passed")} : Verdict{"failed", tr("Not passed")};
}

/// What a page says in a row, with dots between.
class Dotted {
 public:
  void put(Json fact) {
    fact["first"] = m_list.empty();
    m_list.push_back(std::move(fact));
  }
  void add(const std::string& text) { put({{"text", text}}); }
  Json list() && { return std::move(m_list); }

 private:
  Json m_list = Json::array();
};

const char* mode_in_words(const Report& r) {
  if (r.attempt.mode == training::AttemptMode::familiarisation) return tr("familiarisation, no score");
  if (r.attempt.mode == training::AttemptMode::demonstration) return tr("demonstration");
  return part_of(r.result, "passed").is_boolean() ? tr("with score") : tr("free practice");
}

Json facts(const Report& r) {
  Dotted facts;
  if (r.attempt.number > 0) facts.add(tr("Attempt {}", r.attempt.number));
  if (r.names && !r.attempt.trainee.empty()) facts.add(r.attempt.trainee);
  facts.add(r.attempt.exercise);
  facts.add(mode_in_words(r));
  facts.add(r.attempt.seed == 0 ? tr("standard patient") : tr("random patient {}", r.attempt.seed));
  const Json& anatomy = part_of(part_of(r.result, "assessment"), "anatomy");
  if (anatomy.is_object()) facts.add(text_in(anatomy, "title"));
  if (!r.attempt.input.empty()) facts.add(tr("input: {}", r.attempt.input.substr(0, r.attempt.input.find(':'))));
  if (!r.attempt.started.empty()) facts.add(r.attempt.started);
  return std::move(facts).list();
}

Json verdict(const Report& r) {
  const Verdict v = verdict_of(r);
  Json out{{"kind", v.kind}, {"word", v.word}};
  const Json& score = part_of(part_of(r.result, "assessment"), "score");
  if (score.is_object() && score.contains("total")) {
    out["total"] = fmt::format("{:.1f}", real_in(score, "total"));
    out["pass_mark"] = fmt::format("{:.0f}", real_in(score, "pass_mark", 80));
  }
  const bool timed = r.result.contains("exercise_seconds");
  out["time"] = minutes(timed ? real_in(r.result, "exercise_seconds") : r.attempt.seconds);
  out["time_is"] = timed ? tr("min:s duration") : tr("min:s simulated");
  if (const Json& errors = part_of(part_of(r.result, "assessment"), "errors"); errors.is_array()) {
    out["errors"] = std::to_string(errors.size());
    out["errors_are"] = errors.size() == 1 ? tr("error") : tr("errors");
  }
  return out;
}

// --- the score ---

Json score_row(const char* name, const std::string& reached, double got, double most, const std::string& how) {
  return {{"name", name},
          {"reached", reached},
          {"points", points(got)},
          {"most", most > 0 ? points(most) : std::string("–")},
          {"how", how}};
}

Json score(const Report& r) {
  const Json& s = part_of(part_of(r.result, "assessment"), "score");
  if (!s.is_object()) return nullptr;
  if (!s.contains("total")) return {{"note", text_in(s, "note")}};
  const Json &got = part_of(s, "points"), &most = part_of(s, "points_at_most");
  struct Part {
    const char *key, *title, *what;
  };
  const Part kParts[] = {
      {"quality", tr("Quality"), tr("share of the steps that were completed, weighted by the exercise")},
      {"time", tr("Time bonus"),
       tr("all points at the expert time, none at the longest time; none before the last step is completed")},
      {"motion", tr("Motion"), tr("not scored: there is no reference group yet")}};
  Json rows = Json::array();
  double sum = 0;
  for (const auto& [key, title, what] : kParts) {
    if (got.is_object() && got.contains(key)) {
      sum += real_in(got, key);
      rows.push_back(score_row(title, fmt::format("{:.0f} %", 100 * real_in(s, key)), real_in(got, key),
                               real_in(most, key), what));
    } else if (s.contains(key) && s[key].is_null()) {
      rows.push_back({{"name", title}, {"reached", "–"}, {"points", "–"}, {"most", "–"}, {"how", what}});
    }
  }
  const double penalties = real_in(s, "penalties"), total = real_in(s, "total");
  rows.push_back(score_row(tr("Errors"), "", -penalties, 0, tr("points of all errors, see below")));
  const bool clamped = std::fabs(sum - penalties - total) > 0.05;
  return {{"table", {{"rows", rows}, {"total", points(total)}, {"sum", clamped ? points(sum - penalties) : ""}}},
          {"failed_by_error", true_in(s, "failed_by_error")}};
}

// --- steps and errors ---

Json steps(const Report& r, const Json& list) {
  if (!list.is_array() || list.empty()) return nullptr;
  std::vector<double> times;
  for (const Json& s : list)
    if (true_in(s, "done")) times.push_back(real_in(s, "at_s"));
  std::sort(times.begin(), times.end());
  Json rows = Json::array();
  for (const Json& s : list) {
    const bool done = true_in(s, "done"), missed = true_in(s, "missed");
    Json row{{"name", text_in(s, "name")},
             {"side", element_title(r, text_in(s, "side"))},
             {"class", done ? "good-text" : "bad-text"},
             {"done", done     ? tr("✓ yes")
                      : missed ? tr("✗ missed")
                               : tr("✗ no")}};
    if (done) {
      const double t = real_in(s, "at_s");
      const auto here = std::lower_bound(times.begin(), times.end(), t);
      row["at"] = minutes(t);
      row["since"] = fmt::format("{:.1f}", t - (here == times.begin() ? 0 : *(here - 1)));
    }
    rows.push_back(std::move(row));
  }
  return {{"rows", rows}};
}

Json timeline(const Report& r, const Json& step_list, const Json& error_list) {
  Timeline t;
  t.length = real_in(r.result, "simulated_seconds", r.attempt.seconds);
  t.clock_from = real_in(r.result, "exercise_from_s", -1);
  std::vector<std::pair<double, const Json*>> done;
  if (step_list.is_array())
    for (const Json& s : step_list)
      if (true_in(s, "done")) done.emplace_back(real_in(s, "at_s"), &s);
  std::stable_sort(done.begin(), done.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  double before = 0;  // a step may be done before an instrument moved
  for (const auto& [at, s] : done) {
    const std::string side = text_in(*s, "side");
    t.bars.push_back({side.empty() ? tr("Steps") : element_title(r, side), text_in(*s, "name"), before, at});
    before = at;
  }
  if (error_list.is_array())
    for (const Json& e : error_list)
      t.errors.push_back({real_in(e, "at_s"),
                          tr("{} at {}: {}", text_in(e, "code"), minutes(real_in(e, "at_s")), text_in(e, "meaning")),
                          true});
  const Json& moments = part_of(r.result, "moments");
  if (moments.is_array())
    for (const Json& m : moments) {
      const std::string what = text_in(m, "what");
      if (what == "step-done" || what == "error") continue;
      const double at = real_in(m, "tick") * sim::kTick;
      if (at >= 0) t.events.push_back({at, tr("{} at {}", text_in(m, "text"), minutes(at)), false});
    }
  if (t.bars.empty() && t.errors.empty() && t.events.empty()) return nullptr;
  for (const PlotMark& m : t.errors) t.length = std::max(t.length, m.x);
  return svg(t);
}

Json errors(const Report& r, const Json& list) {
  if (!list.is_array()) return nullptr;
  Json rows = Json::array();
  double sum = 0;
  for (const Json& e : list) {
    sum += real_in(e, "points");
    rows.push_back({{"code", text_in(e, "code")},
                    {"meaning", text_in(e, "meaning")},
                    {"detail", text_in(e, "detail")},
                    {"better", text_in(e, "hint")},
                    {"fail", true_in(e, "fail")},
                    {"side", element_title(r, text_in(e, "side"))},
                    {"at", minutes(real_in(e, "at_s"))},
                    {"points", points(real_in(e, "points"))}});
  }
  return {{"rows", rows}, {"sum", rows.empty() ? "" : points(sum)}};
}

// --- what was measured of each side, and against which thresholds ---

std::string shown(const Json& v, const Label& label) {
  if (v.is_string()) return v.get<std::string>();
  if (v.is_boolean()) return v.get<bool>() ? tr("yes") : tr("no");
  if (v.is_number()) return quantity(v.get<double>(), label);
  if (v.is_object() && v.contains("from") && v.contains("to") && v["from"].is_number() && v["to"].is_number())
    return quantity(v["from"].get<double>(), v["to"].get<double>(), label);
  return v.is_null() || v.is_structured() ? "–" : v.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Rows of objects with (mostly) the same keys, for table.html.
Json table(const Json& rows, const std::string& caption) {
  std::vector<std::string> keys;
  for (const Json& row : rows)
    for (const auto& [key, value] : row.items())
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  Json columns = Json::array(), lines = Json::array();
  for (const std::string& key : keys) columns.push_back(label_of(key).title);
  for (const Json& row : rows) {
    Json cells = Json::array();
    for (const std::string& key : keys) cells.push_back(row.contains(key) ? shown(row[key], label_of(key)) : "");
    lines.push_back({{"cells", cells}});
  }
  return {{"caption", caption}, {"columns", columns}, {"lines", lines}};
}

bool is_table(const Json& v) {
  return v.is_array() && !v.empty() && std::all_of(v.begin(), v.end(), [](const Json& x) { return x.is_object(); });
}

Json sides(const Report& r, const Json& list) {
  if (!is_table(list)) return nullptr;
  Json out = Json::array();
  for (const Json& side : list) {
    Json tables = Json::array();
    Dotted facts;
    for (const auto& [key, value] : side.items()) {
      if (key == "side") continue;
      const Label label = label_of(key);
      if (is_table(value))
        tables.push_back(table(value, label.title));
      else if (!value.is_array())
        facts.put({{"name", label.title}, {"value", shown(value, label)}});
    }
    Json all = std::move(facts).list();
    if (all.empty() && tables.empty()) continue;
    out.push_back({{"side", element_title(r, text_in(side, "side"))},
                   {"has_facts", !all.empty()},
                   {"facts", all},
                   {"tables", tables}});
  }
  return out.empty() ? Json() : Json{{"list", out}};
}

Json thresholds(const Json& assessment) {
  const Json& t = part_of(assessment, "thresholds");
  if (!t.is_object() || t.empty()) return nullptr;
  Json rows = Json::array();
  for (const auto& [key, v] : t.items()) {
    const Label label = label_of(key);
    const std::string value = v.contains("value") ? shown(v["value"], label) : shown(v, label);
    rows.push_back({{"name", label.title}, {"value", value}, {"source", text_in(v, "source")}});
  }
  const Json& later = part_of(assessment, "not_assessed");
  return {{"rows", rows},
          {"not_assessed", is_table(later) ? table(later, tr("Errors that are not detected yet")) : Json()}};
}

// --- pictures, notices, foot ---

Json moments(const Report& r) {
  if (r.pictures.empty()) return r.pictures_note.empty() ? Json() : Json{{"note", r.pictures_note}};
  Json list = Json::array();
  for (const ReportPicture& p : r.pictures)
    list.push_back({{"file", p.file.filename().string()}, {"at", minutes(p.seconds)}, {"shows", p.shows}});
  return {{"list", list}};
}

Json notices(const Json& result) {
  const Json& list = part_of(result, "notices");
  if (!list.is_array() || list.empty()) return nullptr;
  return {{"count", list.size() == 1 ? std::string(tr("There was one message about storing this attempt."))
                                     : tr("There were {} messages about storing this attempt.", list.size())}};
}

/// What was not recorded because a list was full.
Json missing(const Json& result) {
  const Json& list = part_of(result, "not_recorded");
  Json lines = Json::array();
  for (const Json& line : list)
    if (line.is_string()) lines.push_back({{"text", line}});
  return lines;
}

Json foot(const Report& r) {
  return {{"uuid", r.attempt.uuid},
          {"version", r.attempt.program_version},
          {"model", core::hex(r.attempt.model_hash)},
          {"recording", fs::path(r.attempt.recording).filename().string()}};
}

}  // namespace

const Json& part_of(const Json& object, const char* key) {
  static const Json nothing;
  return object.is_object() && object.contains(key) ? object[key] : nothing;
}

Json page_data(const Report& r) {
  const std::string title = r.attempt.title.empty() ? r.attempt.exercise : r.attempt.title;
  const Json& a = part_of(r.result, "assessment");
  const bool interrupted = r.attempt.state == training::AttemptState::interrupted;
  return {{"title", title.empty() ? "Trocar" : title},
          {"number", r.attempt.number > 0 ? std::to_string(r.attempt.number) : ""},
          {"facts", facts(r)},
          {"verdict", verdict(r)},
          {"interrupted", interrupted ? minutes(r.attempt.seconds) : ""},
          {"failure", text_in(r.result, "failure")},
          {"missing", missing(r.result)},
          {"score", score(r)},
          {"timeline", timeline(r, part_of(a, "steps"), part_of(a, "errors"))},
          {"steps", steps(r, part_of(a, "steps"))},
          {"errors", errors(r, part_of(a, "errors"))},
          {"pictures", moments(r)},
          {"sides", sides(r, part_of(a, "details"))},
          {"motion", motion_data(r)},
          {"metrics", metrics_data(r)},
          {"learning", learning_data(r)},
          {"thresholds", thresholds(a)},
          {"notices", notices(r.result)},
          {"foot", foot(r)}};
}

}  // namespace trocar::reports
