#include "report_page.hpp"

#include <fstream>

#include <fmt/format.h>

#include <trocar/core/error.hpp>

#include "paths.hpp"

namespace trocar::app {

namespace fs = std::filesystem;

namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string shown(const Json& value) {
  if (value.is_string()) return escaped(value.get<std::string>());
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
  return escaped(value.dump());
}

bool is_table(const Json& value) { return value.is_array() && !value.empty() && value.front().is_object(); }

/// Rows of objects with (mostly) the same keys.
std::string table(const Json& rows) {
  std::string out = "<table><tr>";
  for (const auto& cell : rows.front().items()) out += "<th>" + escaped(cell.key()) + "</th>";
  out += "</tr>\n";
  for (const Json& row : rows) {
    out += "<tr>";
    for (const auto& head : rows.front().items())
      out += "<td>" + (row.contains(head.key()) ? shown(row[head.key()]) : "") + "</td>";
    out += "</tr>\n";
  }
  return out + "</table>\n";
}

/// Everything that a result says, section by section: plain values first, then lists and objects with a heading.
std::string section(const Json& object, int level) {
  std::string plain, rest;
  for (const auto& entry : object.items()) {
    const Json& v = entry.value();
    const std::string heading = fmt::format("<h{0}>{1}</h{0}>\n", level, escaped(entry.key()));
    if (entry.key() == "pictures") continue;
    if (v.is_object() && !v.empty())
      rest += heading + section(v, level + 1);
    else if (is_table(v))
      rest += heading + table(v);
    else
      plain += fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", escaped(entry.key()), shown(v));
  }
  return (plain.empty() ? "" : "<table>" + plain + "</table>\n") + rest;
}

std::string verdict(const Json& result) {
  if (!result.contains("passed") || result["passed"].is_null()) return "practice";
  return result["passed"].get<bool>() ? "passed" : "not passed";
}

constexpr const char* kStyle =
    "body{font:16px/1.5 system-ui,sans-serif;max-width:60em;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;margin:.5em 0}th,td{text-align:left;padding:.2em .8em;border-bottom:1px solid #ddd}"
    "figure{display:inline-block;margin:.5em}img{width:18em;border-radius:4px}figcaption{font-size:.8em;color:#555}";

}  // namespace

std::string report_html(const Json& result) {
  const std::string title = result.contains("exercise") ? shown(result["exercise"]) : "Trocar";
  std::string page = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\">\n<title>{0}</title><style>{1}</style>\n<h1>{0}: {2}</h1>\n",
      title, kStyle, verdict(result));
  if (result.contains("pictures"))
    for (const Json& p : result["pictures"]) {
      const std::string name = fs::path(p.get<std::string>()).filename().string();
      page += fmt::format("<figure><img src=\"{0}\" alt=\"\" loading=\"lazy\"><figcaption>{0}</figcaption></figure>\n",
                          escaped(name));
    }
  return page + section(result, 2) + "</html>\n";
}

std::string write_report(const fs::path& folder, const Json& result) {
  make_folder(folder);
  if (result.contains("pictures"))
    for (const Json& p : result["pictures"]) {
      const fs::path from = p.get<std::string>(), to = folder / from.filename();
      std::error_code error;
      if (!fs::equivalent(from, to, error)) fs::copy_file(from, to, fs::copy_options::overwrite_existing, error);
    }
  const fs::path path = folder / "index.html";
  std::ofstream out(path);
  out << report_html(result);
  if (!out.flush()) throw core::EnvironmentLacks(fmt::format("cannot write {}: is the disk full?", path.string()));
  return path.string();
}

}  // namespace trocar::app
