#include <algorithm>
#include <map>

#include <fmt/format.h>

#include <trocar/core/hash.hpp>
#include <trocar/reports/export.hpp>
#include <trocar/training/store/json_fields.hpp>

namespace trocar::reports {
namespace {

using training::Attempt;

/// "T1", "T2", ...: the same letter for the same trainee within one export.
class Aliases {
 public:
  explicit Aliases(bool names) : m_names(names) {}
  std::string of(const std::string& trainee) {
    if (m_names) return trainee;
    const auto [at, fresh] = m_known.emplace(trainee, fmt::format("T{}", m_known.size() + 1));
    return at->second;
  }

 private:
  bool m_names;
  std::map<std::string, std::string> m_known;
};

/// {"both":{"path_m":1}} -> "both.path_m"; of lists only those whose members have names.
void flatten(const Json& value, const std::string& name, std::vector<std::pair<std::string, std::string>>& out) {
  if (value.is_object()) {
    for (const auto& [key, member] : value.items())
      if (key != "name") flatten(member, name.empty() ? key : name + "." + key, out);
  } else if (value.is_array()) {
    for (const Json& member : value)
      if (member.is_object() && member.contains("name") && member["name"].is_string())
        flatten(member, name + "." + member["name"].get<std::string>(), out);
  } else if (value.is_number()) {
    out.emplace_back(name, value.dump());
  }
}

std::string figure(const Json& result, const char* pointer) {
  const Json::json_pointer at(pointer);
  return result.contains(at) && result[at].is_number() ? result[at].dump() : std::string();
}

constexpr const char* kFirst[] = {"number",      "uuid",        "trainee",   "exercise", "mode",  "seed",
                                  "input",       "started_utc", "ended_utc", "state",    "score", "passed",
                                  "simulated_s", "exercise_s",  "errors",    "penalties"};

}  // namespace

Json result_of(const Attempt& a) {
  Json r = training::json_in(a.result);
  return r.is_object() ? r : Json::object();
}

std::string csv_field(const std::string& text) {
  std::string out;
  const bool formula = !text.empty() && std::string("=+-@\t\r").find(text[0]) != std::string::npos;
  char* end = nullptr;
  const bool is_number = !text.empty() && (std::strtod(text.c_str(), &end), *end == 0);
  if (formula && !is_number) out = "'";
  out += text;
  if (out.find_first_of(",\"\n\r") == std::string::npos) return out;
  std::string quoted(1, '"');
  for (const char c : out) quoted.append(c == '"' ? 2 : 1, c);
  quoted += '"';
  return quoted;
}

std::string attempts_csv(const std::vector<Attempt>& attempts, bool names) {
  Aliases aliases(names);
  std::vector<std::vector<std::string>> rows;
  std::vector<std::map<std::string, std::string>> metrics;
  std::vector<std::string> columns;
  for (const Attempt& a : attempts) {
    const Json result = result_of(a);
    const Json::json_pointer errors("/assessment/errors");
    rows.push_back({std::to_string(a.number), a.uuid, aliases.of(a.trainee), a.exercise, name_of(a.mode),
                    std::to_string(a.seed), a.input, a.started, a.ended, name_of(a.state),
                    a.score ? fmt::format("{:.6g}", *a.score) : "", a.passed ? (*a.passed ? "1" : "0") : "",
                    fmt::format("{:.3f}", a.seconds), figure(result, "/exercise_seconds"),
                    result.contains(errors) && result[errors].is_array() ? std::to_string(result[errors].size()) : "",
                    figure(result, "/assessment/score/penalties")});
    std::vector<std::pair<std::string, std::string>> flat;
    if (result.contains("metrics")) flatten(result["metrics"], "", flat);
    metrics.emplace_back(flat.begin(), flat.end());
    for (const auto& [name, value] : flat)
      if (std::find(columns.begin(), columns.end(), name) == columns.end()) columns.push_back(name);
  }
  const auto end_line = [](std::string& line) { line.back() = '\r', line += '\n'; };  // the last comma becomes the end
  std::string out;
  for (const char* name : kFirst) out.append(name).append(",");
  for (const std::string& name : columns) out.append(csv_field(name)).append(",");
  end_line(out);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const std::string& field : rows[i]) out.append(csv_field(field)).append(",");
    for (const std::string& name : columns) {
      const auto at = metrics[i].find(name);
      if (at != metrics[i].end()) out += at->second;
      out += ',';
    }
    end_line(out);
  }
  return out;
}

Json attempts_json(const std::vector<Attempt>& attempts, bool names) {
  Aliases aliases(names);
  Json list = Json::array();
  for (const Attempt& a : attempts) {
    Json one{{"number", a.number},
             {"uuid", a.uuid},
             {"trainee", aliases.of(a.trainee)},
             {"exercise", a.exercise},
             {"title", a.title},
             {"mode", name_of(a.mode)},
             {"seed", a.seed},
             {"input", a.input},
             {"started", a.started},
             {"ended", a.ended},
             {"state", name_of(a.state)},
             {"score", a.score ? Json(*a.score) : Json(nullptr)},
             {"passed", a.passed ? Json(*a.passed) : Json(nullptr)},
             {"simulated_seconds", a.seconds},
             {"ticks", a.ticks},
             {"recording", a.recording},
             {"program_version", a.program_version},
             {"model_hash", core::hex(a.model_hash)},
             {"has_trace", a.has_trace}};
    if (is_unverified(a)) one["unverified"] = true;
    one["result"] = result_of(a);
    list.push_back(std::move(one));
  }
  return list;
}

}  // namespace trocar::reports
