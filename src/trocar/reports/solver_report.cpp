#include <cmath>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/reports/page_template.hpp>
#include <trocar/reports/report_svg.hpp>
#include <trocar/reports/solver_report.hpp>

namespace trocar::reports {

using attempt::SolverSample;

namespace {

constexpr int kPlotColumns = 760;

std::string cell(double value, const char* format) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : std::string();
}
std::string shown(double value, const char* format) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : std::string("–");
}
Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Series series(const std::string& name, int style, const std::vector<SolverSample>& samples,
              double (*of)(const SolverSample&)) {
  Series s{name, {}, {}, style};
  for (const SolverSample& sample : samples) {
    s.x.push_back(sample.seconds);
    s.y.push_back(of(sample));
  }
  return thinned(s, kPlotColumns);
}

Json drawing(const char* id, const char* title, const char* unit, std::vector<Series> all) {
  Plot plot;
  plot.id = id;
  plot.title = title;
  plot.description = "over time";
  plot.x_label = "s";
  plot.y_label = unit;
  plot.series = std::move(all);
  return {{"title", plot.title}, {"legend", legend(plot.series)}, {"drawing", svg(plot)}};
}

Json drawings(const std::vector<SolverSample>& all) {
  return Json::array({
      drawing("apart", "Distance between both skins", "mm",
              {series("root mean square", 0, all, [](const SolverSample& s) { return 1e3 * s.rms; }),
               series("largest", 1, all, [](const SolverSample& s) { return 1e3 * s.largest; })}),
      drawing("moved", "Indentation, as the dynamic solver has it", "mm",
              {series("indentation", 2, all, [](const SolverSample& s) { return 1e3 * s.moved; })}),
      drawing("force", "Force on the instruments", "N",
              {series("dynamic", 0, all, [](const SolverSample& s) { return s.dynamic_force; }),
               series("static", 1, all, [](const SolverSample& s) { return s.static_force; })}),
  });
}

Json row(const std::string& name, const SolverSample& s) {
  return {{"name", name},
          {"moved", shown(1e3 * s.moved, "{:.2f}")},
          {"rms", shown(1e3 * s.rms, "{:.3f}")},
          {"rms_share", shown(100 * s.share(s.rms), "{:.1f}")},
          {"largest", shown(1e3 * s.largest, "{:.3f}")},
          {"largest_share", shown(100 * s.share(s.largest), "{:.1f}")},
          {"dynamic", shown(s.dynamic_force, "{:.3f}")},
          {"static", shown(s.static_force, "{:.3f}")},
          {"force_share", shown(100 * s.force_share(), "{:+.1f}")}};
}

Json page_data(const SolverReport& r) {
  const char* held = r.summary.held.settled ? "pressed in and at rest" : "at the deepest indentation";
  Json rows = Json::array({row(held, r.summary.held), row("where both are farthest apart", r.summary.worst)});
  Json presses = Json::array(), pictures = Json::array();
  for (const SolverPress& p : r.presses)
    presses.push_back(row(tr("{:.0f} % of its size, {:.1f} mm", 100 * p.share, 1e3 * p.depth), p.summary.held));
  for (const pictures::SolverPicture& p : r.pictures) pictures.push_back({{"file", p.file}, {"text", p.text}});
  return {{"organ", r.organ},
          {"scene", r.scene},
          {"hands", r.hands},
          {"size", fmt::format("{:.1f}", 1e3 * r.size)},
          {"rows", rows},
          {"presses", presses.empty() ? Json(nullptr) : Json{{"rows", presses}}},
          {"drawings", drawings(r.samples)},
          {"pictures", pictures},
          {"pictures_note", r.pictures_note},
          {"version", TROCAR_VERSION}};
}

}  // namespace

std::string difference_csv(const std::vector<SolverSample>& samples) {
  std::string out =
      "time_s,moved_mm,rms_mm,largest_mm,rms_percent,largest_percent,dynamic_N,static_N,force_percent,settled\n";
  for (const SolverSample& s : samples)
    out += fmt::format("{:.3f},{:.4f},{:.4f},{:.4f},{},{},{:.4f},{:.4f},{},{}\n", s.seconds, 1e3 * s.moved, 1e3 * s.rms,
                       1e3 * s.largest, cell(100 * s.share(s.rms), "{:.3f}"), cell(100 * s.share(s.largest), "{:.3f}"),
                       s.dynamic_force, s.static_force, cell(100 * s.force_share(), "{:.2f}"), int(s.settled));
  return out;
}

Json as_json(const SolverSample& s) {
  return {{"seconds", s.seconds},
          {"moved_mm", 1e3 * s.moved},
          {"rms_mm", 1e3 * s.rms},
          {"largest_mm", 1e3 * s.largest},
          {"rms_percent", number_or_null(100 * s.share(s.rms))},
          {"largest_percent", number_or_null(100 * s.share(s.largest))},
          {"dynamic_N", s.dynamic_force},
          {"static_N", s.static_force},
          {"force_percent", number_or_null(100 * s.force_share())},
          {"settled", s.settled}};
}

std::string solvers_html(const SolverReport& report) { return fill(page_text("solvers.html"), page_data(report)); }

std::string write_solver_report(const std::filesystem::path& folder, const SolverReport& report) {
  write_page(folder / "difference.csv", difference_csv(report.samples));
  const std::filesystem::path page = folder / "index.html";
  write_page(page, solvers_html(report));
  return page.string();
}

}  // namespace trocar::reports
