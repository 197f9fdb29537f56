#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/reports/design_page.hpp>
#include <trocar/reports/page_template.hpp>
#include <trocar/reports/report_svg.hpp>

namespace trocar::reports {

using namespace studies;
using kinematics::Mechanism;

namespace {

constexpr std::size_t kMostBars = 15, kMostCurves = 6;

Json table(const std::string& caption, std::vector<std::string> columns,
           const std::vector<std::vector<std::string>>& lines) {
  Json rows = Json::array();
  for (const std::vector<std::string>& line : lines) rows.push_back({{"cells", line}});
  return {{"caption", caption}, {"columns", std::move(columns)}, {"lines", rows}};
}
Json section(const std::string& heading, const std::string& drawing, const std::string& keys, Json figures,
             const std::string& note = "") {
  return {{"heading", heading}, {"drawing", drawing}, {"legend", keys}, {"table", std::move(figures)}, {"note", note}};
}
std::string page_of(const std::string& title, const std::vector<std::string>& lead, Json sections) {
  return fill(page_text("design.html"),
              {{"title", title}, {"lead", lead}, {"sections", std::move(sections)}, {"version", TROCAR_VERSION}});
}

/// Counts as a line of steps, with what is good marked.
std::string histogram(const Statistics& s, const TolerancePage& page) {
  Series steps{"samples", {}, {}, 0};
  const double width = (s.high - s.low) / double(s.bins.size());
  for (std::size_t k = 0; k < s.bins.size(); ++k)
    for (const std::size_t edge : {k, k + 1}) {
      steps.x.push_back(page.by * (s.low + double(edge) * width));
      steps.y.push_back(double(s.bins[k]));
    }
  Plot plot;
  plot.id = "histogram";
  plot.title = "Histogram of the deviation from nominal";
  plot.description = tr("{} samples in {} bins", s.samples - s.open, s.bins.size());
  plot.x_label = "deviation [" + page.unit + "]";
  plot.y_label = "samples";
  plot.series = {steps};
  for (const double limit : {page.limits.low, page.limits.high})
    if (limit > s.low && limit < s.high) plot.marks.push_back({page.by * limit, "limit", true});
  plot.height = 260;
  return svg(plot);
}

/// The largest effects, a bar each.
std::string effect_bars(const ToleranceStudy& study, const TolerancePage& page) {
  const std::vector<Sensitivity>& ranked = study.linear().ranked;
  const std::size_t count = std::min(kMostBars, ranked.size());
  if (count == 0) return {};
  constexpr double kWidth = 760, kName = 220, kBar = 20, kFigures = 110;
  const double most = std::max(std::fabs(ranked[0].effect()), 1e-300), height = double(count) * kBar + 6;
  std::string out = fmt::format(
      "<svg viewBox=\"0 0 {} {}\" role=\"img\"><title>What matters most</title><desc>effects of the {} largest "
      "dimensions, as in the table</desc>",
      kWidth, height, count);
  for (std::size_t k = 0; k < count; ++k) {
    const double y = double(k) * kBar, wide = (kWidth - kName - kFigures) * std::fabs(ranked[k].effect()) / most;
    out += fmt::format(
        "<text class=\"tick\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text><rect class=\"bar b0\" x=\"{}\" "
        "y=\"{:.1f}\" width=\"{:.1f}\" height=\"{}\"/><text class=\"tick\" x=\"{:.1f}\" y=\"{:.1f}\">{:+.3g} "
        "{}</text>\n",
        kName - 8, y + 0.7 * kBar, escaped(study.mechanism().parameters[std::size_t(ranked[k].parameter)].name), kName,
        y + 2, wide, kBar - 4, kName + wide + 6, y + 0.7 * kBar, page.by * ranked[k].effect(), escaped(page.unit));
  }
  return out + "</svg>\n";
}

std::string pair_name(const Mechanism& m, const PairClearance& p) {
  return m.links[std::size_t(p.first)] + " and " + m.links[std::size_t(p.second)];
}

std::string curves(const ClearanceReport& r, const std::vector<Series>& all, const char* id) {
  Plot plot;
  plot.id = id;
  plot.title = "Clearance over the motion";
  plot.description = "below 0 links are in each other";
  plot.x_label = r.drives.empty() ? "handle" : r.drives[0];
  plot.y_label = "mm";
  plot.series = all;
  plot.levels = {{0, "touching"}};
  double low = 0, high = 0;
  for (const Series& s : all)
    for (const double y : s.y)
      if (std::isfinite(y)) low = std::min(low, y), high = std::max(high, y);
  plot.y_from = low - 0.05 * (high - low + 0.01);
  plot.y_to = high + 0.05 * (high - low + 0.01);
  plot.height = 280;
  return svg(plot);
}
Series curve(const ClearanceReport& r, const PairClearance& p, const std::string& name, int style) {
  Series s{name, r.handles, {}, style};
  for (const double c : p.curve) s.y.push_back(1e3 * c);
  return s;
}

Json clearance_section(const Mechanism& m, const ClearanceReport& r) {
  std::vector<Series> all;
  std::vector<std::vector<std::string>> lines;
  for (const PairClearance& p : r.pairs) {
    if (r.drives.size() == 1 && all.size() < kMostCurves) all.push_back(curve(r, p, pair_name(m, p), int(all.size())));
    std::string where;
    for (std::size_t d = 0; d < p.handles.size(); ++d)
      where += fmt::format("{}{} {:.4f}", d ? ", " : "", r.drives[d], p.handles[d]);
    lines.push_back(
        {pair_name(m, p), fmt::format("{:.4f}", 1e3 * p.least), fmt::format("{:.4f}", 1e3 * p.most), where});
  }
  std::string joined;
  for (const PairClearance& p : r.joined) joined += (joined.empty() ? "" : "; ") + pair_name(m, p);
  return section("Clearance over the motion", all.empty() ? "" : curves(r, all, "clearance"), legend(all),
                 table("Pairs of links that are no neighbours, the nearest first",
                       {"links", "least mm", "most mm", "least where"}, lines),
                 joined.empty() ? "" : "In each other in every pose, so meant to be: " + joined + ".");
}

}  // namespace

std::string tolerance_html(const ToleranceStudy& study, const Statistics& s, const TolerancePage& page) {
  const LinearTolerance& l = study.linear();
  const Mechanism& m = study.mechanism();
  const auto shown = [&](double v) { return fmt::format("{:.3f} {}", page.by * v, page.unit); };
  std::vector<std::vector<std::string>> ranked;
  for (const Sensitivity& x : l.ranked) {
    const kinematics::Parameter& p = m.parameters[std::size_t(x.parameter)];
    const bool angle = p.measure == kinematics::Measure::angle;
    ranked.push_back({p.name,
                      angle ? fmt::format("{:.4g} deg", x.plus_minus * 180 / portable::pi)
                            : fmt::format("{:.4g} um", 1e6 * x.plus_minus),
                      shown(x.effect()), fmt::format("{:.2f} %", 100 * x.share)});
  }
  std::vector<std::vector<std::string>> figures{{"worst sum of all effects", shown(l.worst), ""},
                                                {"root of the sum of squares", shown(l.rss), ""},
                                                {"standard deviation", shown(l.deviation), shown(s.deviation)},
                                                {"mean", shown(0), shown(s.mean)},
                                                {"least, greatest", "", shown(s.low) + ", " + shown(s.high)}};
  for (std::size_t k = 0; k < kPercentiles.size(); ++k)
    figures.push_back({fmt::format("percentile {}", kPercentiles[k]), "", shown(s.percentiles[k])});
  std::string misfits;
  for (const Misfit& x : study.misfits())
    misfits += (misfits.empty() ? "" : ", ") + m.parameters[std::size_t(x.parameter)].name;
  std::vector<std::string> lead{
      tr("{}: what errors of {} dimensions do to the {}. {} samples, {} of which did "
         "not close.",
         m.name, l.ranked.size(), page.measured, s.samples, s.open)};
  if (std::isfinite(page.limits.high))
    lead.push_back(tr("Yield: {:.3f} % are within {}.", 100 * s.yield, shown(page.limits.high)));
  return page_of(m.name + ": tolerances", lead,
                 Json::array({section("Deviation from nominal", histogram(s, page), "",
                                      table("", {"", "first order", "Monte Carlo"}, figures)),
                              section("What matters most", effect_bars(study, page), "",
                                      table("Effect: slope times error",
                                            {"dimension", "plus or minus", "effect", "share of variance"}, ranked),
                                      misfits.empty()
                                          ? ""
                                          : "Left out, as the loops would stand open if they changed alone (play takes "
                                            "it up, or it strains the parts): " +
                                                misfits + ".")}));
}

std::string clearance_html(const Mechanism& m, const ClearanceReport& r) {
  std::vector<std::string> lead{tr("{} poses, {} of them closed and within limits.", r.poses, r.reached)};
  if (!r.pairs.empty())
    lead.push_back(fmt::format("{} {} at {:.4f} mm.", pair_name(m, r.pairs[0]),
                               r.least < 0 ? "are deepest in each other" : "come nearest", 1e3 * r.least));
  return page_of(m.name + ": clearance of its own links", lead, Json::array({clearance_section(m, r)}));
}

std::string optimise_html(const Mechanism& m, const OptimiseResult& r, double wish) {
  std::vector<std::vector<std::string>> lines;
  for (const int i : r.parameters) {
    const kinematics::Parameter& p = m.parameters[std::size_t(i)];
    const double by = p.measure == kinematics::Measure::angle    ? 180 / portable::pi
                      : p.measure == kinematics::Measure::length ? 1e3
                                                                 : 1;
    const char* unit = p.measure == kinematics::Measure::angle    ? " deg"
                       : p.measure == kinematics::Measure::length ? " mm"
                                                                  : "";
    lines.push_back({p.name + unit, fmt::format("{:.4f}", by * m.parameter_values[std::size_t(i)]),
                     fmt::format("{:.4f}", by * r.values[std::size_t(i)]),
                     fmt::format("{:.4g} to {:.4g}", by * p.low, by * p.high)});
  }
  const auto least = [](const ClearanceReport& c) {
    return c.pairs.empty() ? std::string("no pairs") : fmt::format("{:.4f} mm", 1e3 * c.least);
  };
  std::vector<Series> all;
  if (r.after.drives.size() == 1 && !r.before.pairs.empty() && !r.after.pairs.empty())
    all = {curve(r.before, r.before.pairs[0], "before: " + pair_name(m, r.before.pairs[0]), 1),
           curve(r.after, r.after.pairs[0], "after: " + pair_name(m, r.after.pairs[0]), 0)};
  return page_of(
      m.name + ": dimensions for clearance",
      {tr("{}: least clearance {} before, {} after; {:.4f} mm were asked for.",
          r.free ? "Free of collisions" : "Not what was asked for", least(r.before), least(r.after), 1e3 * wish),
       tr("The frame's range is {:.1f} % of what it was. {} mechanisms tried from {} starts.",
          r.range_before > 0 ? 100 * r.range_after / r.range_before : 100, r.evaluations, r.starts)},
      Json::array({section("Dimensions", all.empty() ? "" : curves(r.after, all, "before-after"), legend(all),
                           table("", {"dimension", "before", "after", "bounds"}, lines)),
                   clearance_section(m, r.after)}));
}

std::string write_design_page(const std::filesystem::path& folder, const std::string& html) {
  const std::filesystem::path page = folder / "index.html";
  write_page(page, html);
  return page.string();
}

}  // namespace trocar::reports
