#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>

#include <fmt/format.h>

#include <trocar/attempt/paths.hpp>
#include <trocar/attempt/session.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/reports/report_look.hpp>
#include <trocar/reports/report_metrics.hpp>
#include <trocar/reports/report_motion.hpp>
#include <trocar/reports/report_page.hpp>
#include <trocar/reports/report_svg.hpp>

namespace trocar::reports {

namespace fs = std::filesystem;

namespace {

double real_in(const Json& object, const char* key, double otherwise = 0) {
  return object.is_object() && object.contains(key) && object[key].is_number() ? object[key].get<double>() : otherwise;
}

bool true_in(const Json& object, const char* key) {
  return object.is_object() && object.contains(key) && object[key].is_boolean() && object[key].get<bool>();
}

const Json& part_of(const Json& object, const char* key) {
  static const Json nothing;
  return object.is_object() && object.contains(key) ? object[key] : nothing;
}

std::string points(double p) { return fmt::format("{:.1f}", std::fabs(p) < 0.05 ? 0.0 : p); }

/// "clip_distance_mm" -> "clip distance [mm]"
std::string words(std::string key) {
  std::string unit;
  const std::size_t last = key.rfind('_');
  for (const char* known : {"mm", "deg", "s", "N"})
    if (last != std::string::npos && key.substr(last + 1) == known) unit = fmt::format(" [{}]", known);
  if (!unit.empty()) key.resize(last);
  std::replace(key.begin(), key.end(), '_', ' ');
  return escaped(key + unit);
}

// --- what it was, and how it ended ---

std::string verdict_word(const Report& r, const char** kind) {
  *kind = "";
  switch (r.attempt.state) {
    case training::AttemptState::interrupted:
      return "Interrupted";
    case training::AttemptState::running:
      return "Still running";
    case training::AttemptState::aborted:
      return "Ended before it was done";
    case training::AttemptState::finished:
      break;
  }
  if (r.result.contains("failure")) return "The simulation failed";
  const Json& passed = part_of(r.result, "passed");
  if (!passed.is_boolean())
    return r.attempt.mode == training::AttemptMode::familiarisation ? "Familiarisation" : "Practice";
  *kind = passed.get<bool>() ? "passed" : "failed";
  return passed.get<bool>() ? "Passed" : "Not passed";
}

std::string head(const Report& r) {
  const std::string title = r.attempt.title.empty() ? r.attempt.exercise : r.attempt.title;
  const char* kind = "";
  const std::string word = verdict_word(r, &kind);
  std::string out = fmt::format("<header><h1>{}</h1>\n<p class=\"note\">", escaped(title));
  std::vector<std::string> facts;
  if (r.attempt.number > 0) facts.push_back(fmt::format("Attempt {}", r.attempt.number));
  if (r.names && !r.attempt.trainee.empty()) facts.push_back(r.attempt.trainee);
  facts.push_back(r.attempt.exercise);
  facts.emplace_back(name_of(r.attempt.mode));
  facts.push_back(r.attempt.seed == 0 ? "anatomy as drawn" : fmt::format("anatomy {}", r.attempt.seed));
  if (!r.attempt.input.empty()) facts.push_back("by " + r.attempt.input.substr(0, r.attempt.input.find(':')));
  if (!r.attempt.started.empty()) facts.push_back(r.attempt.started);
  for (std::size_t i = 0; i < facts.size(); ++i) out += (i ? " · " : "") + escaped(facts[i]);
  out += fmt::format("</p>\n<div class=\"verdict {}\"><b class=\"word\">{}</b>\n", kind, word);
  const Json& score = part_of(part_of(r.result, "assessment"), "score");
  if (score.is_object() && score.contains("total"))
    out += fmt::format("<span><b>{:.1f}</b> of 100, pass mark {:.0f}</span>\n", real_in(score, "total"),
                       real_in(score, "pass_mark", 80));
  if (r.result.contains("exercise_seconds"))
    out += fmt::format("<span><b>{}</b> min:s</span>\n", minutes(real_in(r.result, "exercise_seconds")));
  else
    out += fmt::format("<span><b>{}</b> min:s simulated</span>\n", minutes(r.attempt.seconds));
  if (const Json& errors = part_of(part_of(r.result, "assessment"), "errors"); errors.is_array())
    out += fmt::format("<span><b>{}</b> {}</span>", errors.size(), errors.size() == 1 ? "error" : "errors");
  out += "</div>\n";
  if (r.attempt.state == training::AttemptState::interrupted)
    out += fmt::format("<p>The program ended without saying so. What is recorded reaches {} (min:s).</p>\n",
                       minutes(r.attempt.seconds));
  if (r.result.contains("failure")) out += "<p class=\"bad-text\">" + escaped(text_in(r.result, "failure")) + "</p>\n";
  return out + "</header>\n";
}

// --- the score ---

std::string score_row(const char* name, const std::string& reached, double got, double most, const std::string& how) {
  return fmt::format(
      "<tr><th scope=\"row\">{}</th><td class=\"n\">{}</td><td class=\"n\">{}</td><td "
      "class=\"n\">{}</td><td>{}</td></tr>\n",
      name, reached, points(got), most > 0 ? points(most) : std::string("–"), how);
}

std::string score(const Report& r) {
  const Json& a = part_of(r.result, "assessment");
  const Json& s = part_of(a, "score");
  if (!s.is_object()) return "";
  const Json &got = part_of(s, "points"), &most = part_of(s, "points_at_most");
  if (!s.contains("total")) return "<section><h2>Score</h2><p>" + escaped(text_in(s, "note")) + "</p></section>\n";
  std::string out =
      "<section><h2>Score</h2>\n<table><caption>Every component, and how they add up</caption><thead><tr><th>component"
      "</th><th class=\"n\">reached</th><th class=\"n\">points</th><th class=\"n\">at most</th><th>what it is</th></tr>"
      "</thead><tbody>\n";
  const auto percent = [](double v) { return fmt::format("{:.0f} %", 100 * v); };
  double sum = 0;
  const std::pair<const char*, const char*> kParts[] = {
      {"quality", "steps done, weighted as the exercise says"},
      {"time", "full marks at the expert's time, none at the longest allowed; none before the exercise is done"},
      {"motion", "motion against a reference group"}};
  for (const auto& [key, what] : kParts) {
    if (!got.is_object() || !got.contains(key)) {
      if (s.contains(key) && s[key].is_null())
        out += fmt::format(
            "<tr><th scope=\"row\">{}</th><td class=\"n\">–</td><td class=\"n\">–</td><td class=\"n\">–</td>"
            "<td>{}: left out, there is no reference group yet</td></tr>\n",
            key, what);
      continue;
    }
    sum += real_in(got, key);
    out += score_row(key, percent(real_in(s, key)), real_in(got, key), real_in(most, key), what);
  }
  const double penalties = real_in(s, "penalties");
  out += score_row("penalties", "", -penalties, 0, "points of all errors, below");
  const double total = real_in(s, "total");
  const bool clamped = std::fabs(sum - penalties - total) > 0.05;
  out += fmt::format(
      "<tr class=\"sum\"><th scope=\"row\">total</th><td></td><td class=\"n\">{}</td><td class=\"n\">100.0"
      "</td><td>{}</td></tr>\n</tbody></table>\n",
      points(total),
      clamped ? fmt::format("the sum is {}; a score lies between 0 and 100", points(sum - penalties)) : "");
  if (true_in(s, "failed_by_error"))
    out += "<p class=\"bad-text\">An error was made that fails the attempt whatever its points.</p>\n";
  return out + "</section>\n";
}

// --- steps and errors ---

std::string steps(const Json& list) {
  if (!list.is_array() || list.empty()) return "";
  std::string out =
      "<section><h2>Steps</h2>\n<div class=\"wide\"><table><thead><tr><th>step</th><th>side</th><th>done</th>"
      "<th class=\"n\">at [min:s]</th><th class=\"n\">after the one before [s]</th></tr></thead><tbody>\n";
  std::vector<double> times;
  for (const Json& s : list)
    if (true_in(s, "done")) times.push_back(real_in(s, "at_s"));
  std::sort(times.begin(), times.end());
  for (const Json& s : list) {
    const bool done = true_in(s, "done"), missed = true_in(s, "missed");
    std::string at, since;
    if (done) {
      const double t = real_in(s, "at_s");
      const auto here = std::lower_bound(times.begin(), times.end(), t);
      at = minutes(t);
      since = fmt::format("{:.1f}", t - (here == times.begin() ? 0 : *(here - 1)));
    }
    out += fmt::format(
        "<tr><td>{}</td><td>{}</td><td class=\"{}\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n",
        escaped(text_in(s, "name")), escaped(text_in(s, "side")), done ? "good-text" : "bad-text",
        done     ? "✓ yes"
        : missed ? "✗ missed"
                 : "✗ no",
        at, since);
  }
  return out + "</tbody></table></div></section>\n";
}

std::string timeline(const Report& r, const Json& step_list, const Json& error_list) {
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
    std::string name = text_in(*s, "step");
    if (name.empty()) name = text_in(*s, "name");
    t.bars.push_back({side.empty() ? "steps" : side + " side", name, before, at});
    before = at;
  }
  if (error_list.is_array())
    for (const Json& e : error_list)
      t.errors.push_back(
          {real_in(e, "at_s"),
           fmt::format("{} at {}: {}", text_in(e, "code"), minutes(real_in(e, "at_s")), text_in(e, "meaning")), true});
  const Json& moments = part_of(r.result, "moments");
  if (moments.is_array())
    for (const Json& m : moments) {
      const std::string what = text_in(m, "what");
      if (what == "step-done" || what == "error") continue;
      const double at = real_in(m, "tick") * sim::kTick;
      if (at >= 0) t.events.push_back({at, fmt::format("{} at {}", text_in(m, "text"), minutes(at)), false});
    }
  if (t.bars.empty() && t.errors.empty() && t.events.empty()) return "";
  for (const PlotMark& m : t.errors) t.length = std::max(t.length, m.x);
  return "<section><h2>Over time</h2>\n" + svg(t) +
         "<p class=\"note\">From the first moment of the simulation on; the exercise's clock, whose time counts, "
         "begins when an "
         "instrument first moves (the dotted line). Each bar ends when its step was done. Triangles are errors, ticks "
         "what the hands did; both "
         "say "
         "what they are under the pointer.</p></section>\n";
}

std::string errors(const Json& list) {
  if (!list.is_array()) return "";
  std::string out = "<section><h2>Errors</h2>\n";
  if (list.empty()) return out + "<p>None.</p></section>\n";
  out +=
      "<div class=\"wide\"><table><thead><tr><th>code</th><th>what</th><th>side</th><th class=\"n\">at [min:s]</th>"
      "<th class=\"n\">points</th></tr></thead><tbody>\n";
  double sum = 0;
  for (const Json& e : list) {
    sum += real_in(e, "points");
    const std::string detail = text_in(e, "detail");
    out +=
        fmt::format("<tr><td>{}</td><td>{}{}{}</td><td>{}</td><td class=\"n\">{}</td><td class=\"n\">−{}</td></tr>\n",
                    escaped(text_in(e, "code")), escaped(text_in(e, "meaning")),
                    detail.empty() ? "" : "<br><span class=\"note\">" + escaped(detail) + "</span>",
                    true_in(e, "fail") ? " <b class=\"bad-text\">fails the attempt</b>" : "",
                    escaped(text_in(e, "side")), minutes(real_in(e, "at_s")), points(real_in(e, "points")));
  }
  out += fmt::format("<tr class=\"sum\"><td></td><td>all</td><td></td><td></td><td class=\"n\">−{}</td></tr>",
                     points(sum));
  return out + "</tbody></table></div></section>\n";
}

// --- what was measured of each side, and against which thresholds ---

std::string shown(const Json& v) {
  if (v.is_string()) return escaped(v.get<std::string>());
  if (v.is_boolean()) return v.get<bool>() ? "yes" : "no";
  if (v.is_number_float()) return fmt::format("{:.4g}", v.get<double>());
  if (v.is_object()) {
    std::string out;
    for (const auto& [key, value] : v.items())
      out += fmt::format("{}{} {}", out.empty() ? "" : ", ", escaped(key), shown(value));
    return out;
  }
  return v.is_null() ? "–" : escaped(v.dump());
}

/// Rows of objects with (mostly) the same keys.
std::string table(const Json& rows, const std::string& caption) {
  std::vector<std::string> keys;
  for (const Json& row : rows)
    for (const auto& [key, value] : row.items())
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  std::string out = "<div class=\"wide\"><table><caption>" + escaped(caption) + "</caption><thead><tr>";
  for (const std::string& key : keys) out += "<th>" + words(key) + "</th>";
  out += "</tr></thead><tbody>\n";
  for (const Json& row : rows) {
    out += "<tr>";
    for (const std::string& key : keys) out += "<td>" + (row.contains(key) ? shown(row[key]) : "") + "</td>";
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

bool is_table(const Json& v) {
  return v.is_array() && !v.empty() && std::all_of(v.begin(), v.end(), [](const Json& x) { return x.is_object(); });
}

std::string sides(const Json& list) {
  if (!is_table(list)) return "";
  std::string out = "<section><h2>What was done to each side</h2>\n";
  for (const Json& side : list) {
    out += "<h3>" + escaped(text_in(side, "side")) + "</h3>\n<p>";
    std::string tables;
    bool first = true;
    for (const auto& [key, value] : side.items()) {
      if (key == "side") continue;
      if (is_table(value))
        tables += table(value, key);
      else if (!value.is_array())
        out += fmt::format("{}{}: {}", first ? "" : " · ", words(key), shown(value)), first = false;
    }
    out += "</p>\n" + tables;
  }
  return out + "</section>\n";
}

std::string thresholds(const Json& assessment) {
  const Json& t = part_of(assessment, "thresholds");
  if (!t.is_object() || t.empty()) return "";
  std::string out =
      "<section><details><summary>Thresholds that applied, and where they come from</summary>\n<div "
      "class=\"wide\"><table>"
      "<thead><tr><th>threshold</th><th>value</th><th>source</th></tr></thead><tbody>\n";
  for (const auto& [key, v] : t.items()) {
    const std::string value = v.contains("value")  ? shown(v["value"])
                              : v.contains("from") ? shown(v["from"]) + " to " + shown(part_of(v, "to"))
                                                   : shown(v);
    out +=
        fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td></tr>\n", words(key), value, escaped(text_in(v, "source")));
  }
  out += "</tbody></table></div>\n";
  if (const Json& n = part_of(assessment, "not_assessed"); is_table(n))
    out += table(n, "Errors that are not looked for yet");
  return out + "</details></section>\n";
}

// --- pictures, notices ---

std::string pictures(const Report& r) {
  if (r.pictures.empty())
    return r.pictures_note.empty()
               ? ""
               : "<section><h2>Moments</h2><p class=\"note\">No pictures: " + escaped(r.pictures_note) +
                     ".</p></section>\n";
  std::string out = "<section><h2>Moments</h2>\n<div class=\"pictures\">\n";
  for (const ReportPicture& p : r.pictures)
    out += fmt::format(
        "<figure><img src=\"{}\" alt=\"Endoscope picture at {}: {}\" width=\"640\" height=\"480\" "
        "loading=\"lazy\"><figcaption>{} · {}</figcaption></figure>\n",
        escaped(p.file.filename().string()), minutes(p.seconds), escaped(p.shows), minutes(p.seconds),
        escaped(p.shows));
  return out + "</div></section>\n";
}

std::string notices(const Json& result) {
  const Json& list = part_of(result, "notices");
  if (!list.is_array() || list.empty()) return "";
  return fmt::format(
      "<section><h2>About keeping this attempt</h2><p>{} {} said on the way: see the program's messages."
      "</p></section>\n",
      list.size(), list.size() == 1 ? "thing was" : "things were");
}

std::string foot(const Report& r) {
  std::string out = "<footer><p>";
  if (!r.attempt.uuid.empty()) out += "Attempt " + escaped(r.attempt.uuid) + ". ";
  out += "Trocar " + escaped(r.attempt.program_version) + ", model " + core::hex(r.attempt.model_hash) + ". ";
  if (!r.attempt.recording.empty())
    out += "Recording " + escaped(fs::path(r.attempt.recording).filename().string()) + ". ";
  return out +
         "</p><p>Limits and weights are from the literature or our own choice; no expert group has confirmed them, and "
         "a "
         "score here certifies nothing.</p></footer>\n";
}

}  // namespace

std::string report_html(const Report& r) {
  const std::string title = r.attempt.title.empty() ? r.attempt.exercise : r.attempt.title;
  const Json& a = part_of(r.result, "assessment");
  std::string page = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<meta name=\"referrer\" content=\"no-referrer\">\n"
      "<title>{}{}</title>\n<style>{}</style></head>\n<body>\n",
      escaped(title.empty() ? "Trocar" : title),
      r.attempt.number > 0 ? fmt::format(", attempt {}", r.attempt.number) : "", kReportStyle);
  page += head(r);
  page += "<main>\n" + score(r);
  page += timeline(r, part_of(a, "steps"), part_of(a, "errors"));
  page += steps(part_of(a, "steps")) + errors(part_of(a, "errors"));
  page += pictures(r);
  page += sides(part_of(a, "sides"));
  const std::string motion = motion_section(r);
  page += motion + metrics_section(r) + learning_section(r) + thresholds(a) + notices(r.result);
  page += "</main>\n" + foot(r);
  if (motion.find("id=\"turn\"") != std::string::npos) page += fmt::format("<script>{}</script>\n", kReportScript);
  return page + "</body></html>\n";
}

std::string write_report(const fs::path& folder, const Report& report) {
  attempt::make_folder(folder);
  Report here = report;
  for (ReportPicture& p : here.pictures) {
    const fs::path to = folder / p.file.filename();
    std::error_code error;
    if (!fs::equivalent(p.file, to, error)) fs::copy_file(p.file, to, fs::copy_options::overwrite_existing, error);
  }
  const fs::path path = folder / "index.html";
  std::ofstream out(path, std::ios::binary);
  out << report_html(here);
  if (!out.flush()) throw core::EnvironmentLacks(fmt::format("cannot write {}: is the disk full?", path.string()));
  return path.string();
}

std::string write_report(const fs::path& folder, const Json& result, const training::Store* store,
                         const attempt::Session* session) {
  training::Attempt attempt;
  const std::string uuid = text_in(part_of(result, "attempt"), "uuid");
  if (store && !uuid.empty())
    if (std::optional<training::Attempt> kept = store->find(uuid)) attempt = std::move(*kept);
  attempt.uuid = uuid;
  attempt.exercise = text_in(result, "exercise");
  attempt.input = text_in(result, "input");
  attempt.mode = training::mode_named(text_in(part_of(result, "attempt"), "mode")).value_or(attempt.mode);
  attempt.state = result.contains("interrupted") ? training::AttemptState::aborted : training::AttemptState::finished;
  if (attempt.program_version.empty()) attempt.program_version = TROCAR_VERSION;
  fill_from_result(result.dump(-1, ' ', false, Json::error_handler_t::replace), attempt);
  if (session) {
    attempt.title = session->lesson().title;
    attempt.model_hash = session->lesson().model.hash;
    attempt.seed = session->lesson().seed;
    attempt.trace = session->trace_bytes();
  }
  Report report = gather(store, std::move(attempt));
  if (session)
    add_pictures(report, *session, folder);
  else if (!report.attempt.recording.empty())
    add_pictures(report, report.attempt.recording, folder);
  return write_report(folder, report);
}

}  // namespace trocar::reports
