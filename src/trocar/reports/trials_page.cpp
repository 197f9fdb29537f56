#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/reports/trials_page.hpp>

namespace trocar::reports {

using training::MetricStudy;
using training::Spread;
using training::Study;

namespace {

// Eight colours that stay apart for colour-blind eyes [Okabe Ito 2008].
constexpr const char* kColours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                    "#56b4e9", "#b8860b", "#000000", "#888"};

const char* colour(std::size_t i) { return kColours[i % std::size(kColours)]; }

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '&')
      out += "&amp;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c >= ' ' || c == '\n' ? c : ' ';
  }
  return out;
}

/// The minus that is as wide as a digit.
std::string typeset(std::string number) {
  for (std::size_t at = 0; (at = number.find('-', at)) != std::string::npos;) number.replace(at, 1, "−");
  return number;
}

std::string figure(double value) { return std::isfinite(value) ? typeset(fmt::format("{:.4g}", value)) : "–"; }
std::string rho(double value) { return std::isfinite(value) ? typeset(fmt::format("{:.2f}", value)) : "–"; }
std::string slope(double value) { return std::isfinite(value) ? typeset(fmt::format("{:.3g}", value)) : "–"; }

/// The figure and, smaller, its range.
std::string with_range(const training::Ranged& r, std::string (*shown)(double)) {
  if (!std::isfinite(r.low)) return shown(r.value);
  return fmt::format("{} <small>({} … {})</small>", shown(r.value), shown(r.low), shown(r.high));
}

std::string heading(const MetricStudy& m) {
  const std::string unit = m.column->unit;
  return escaped(m.column->title) + (unit.empty() ? "" : " [" + unit + "]");
}

// --- drawings ---

/// The step of 1, 2 or 5 times a power of ten that divides `range` into at most `wanted` parts.
double tick_step(double range, int wanted) {
  const double least = range / wanted;
  double power = 1;
  while (power > least) power /= 10;
  while (power * 10 <= least) power *= 10;
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= least) return factor * power;
  return 10 * power;
}

/// Maps a repetition and a value to the drawing.
struct Axes {
  double width = 420, height = 240, left = 56, bottom = 34, top = 12, right = 12;
  double most_repetition = 1, low = 0, high = 1;

  double x(double repetition) const {
    return left + (width - left - right) * (repetition - 0.5) / std::max(most_repetition, 1.0);
  }
  double y(double value) const { return height - bottom - (height - bottom - top) * (value - low) / (high - low); }
};

Axes axes_for(const MetricStudy& m) {
  Axes a;
  a.most_repetition = double(m.by_repetition.size());
  a.low = m.all.least;
  a.high = m.all.most;
  if (a.low > 0 && a.low < 0.5 * a.high) a.low = 0;  // show how large a change is, where that does not hide it
  const double margin = 0.05 * (a.high - a.low);
  if (!(margin > 0)) return a.low -= 0.5, a.high += 0.5, a;
  a.high += margin;
  if (a.low != 0) a.low -= margin;
  return a;
}

std::string frame(const Axes& a) {
  std::string out;
  const double step = tick_step(a.high - a.low, 5);
  for (double v = std::ceil(a.low / step) * step; v <= a.high; v += step)
    out += fmt::format(
        "<path class=\"grid\" d=\"M{:.1f} {:.1f}H{:.1f}\"/><text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{:.4g}"
        "</text>\n",
        a.left, a.y(v), a.width - a.right, a.left - 6, a.y(v) + 4, std::fabs(v) < 1e-9 * step ? 0 : v);
  const int every = a.most_repetition > 20 ? int(a.most_repetition / 10) : (a.most_repetition > 10 ? 2 : 1);
  for (int r = 1; r <= int(a.most_repetition); r += every)
    out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n", a.x(r), a.height - 16, r);
  return out + fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">repetition</text>\n",
                           (a.left + a.width - a.right) / 2, a.height - 2);
}

/// Band between the quartiles, line through the medians of each repetition.
std::string band(const MetricStudy& m, const Axes& a) {
  std::string upper, lower, median;
  for (std::size_t r = 0; r < m.by_repetition.size(); ++r) {
    const Spread& s = m.by_repetition[r];
    if (s.count == 0) continue;
    const double x = a.x(double(r) + 1);
    upper += fmt::format("{}{:.1f} {:.1f}", upper.empty() ? "M" : "L", x, a.y(s.upper));
    lower.insert(0, fmt::format("L{:.1f} {:.1f}", x, a.y(s.lower)));
    median += fmt::format("{}{:.1f} {:.1f}", median.empty() ? "M" : "L", x, a.y(s.median));
  }
  return fmt::format("<path class=\"band\" d=\"{}{}Z\"/><path class=\"median\" d=\"{}\"/>\n", upper, lower, median);
}

std::string points(const Study& study, const MetricStudy& m, const Axes& a) {
  std::string out;
  for (const training::StudyAttempt& attempt : study.attempts) {
    const double value = m.column->get(attempt.metrics);
    if (!std::isfinite(value)) continue;
    const auto person =
        std::size_t(std::find(study.persons.begin(), study.persons.end(), attempt.person) - study.persons.begin());
    // Persons side by side within a repetition, so that equal values stay visible.
    const double shift = (double(person) - 0.5 * double(study.persons.size() - 1)) * 1.6;
    out +=
        fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.6\" fill=\"{}\"><title>{} {}: {:.4g}</title></circle>",
                    a.x(attempt.repetition) + shift, a.y(value), colour(person), escaped(attempt.person),
                    escaped(attempt.trial), value);
  }
  return out + "\n";
}

std::string drawing(const Study& study, const MetricStudy& m) {
  const Axes a = axes_for(m);
  return fmt::format(
      "<figure><figcaption>{}</figcaption><svg viewBox=\"0 0 {} {}\" role=\"img\">\n{}{}{}</svg></figure>\n",
      heading(m), a.width, a.height, frame(a), band(m, a), points(study, m, a));
}

// --- tables ---

std::string spread_table(const Study& study) {
  std::string out =
      "<table><tr><th>Metric</th><th>median</th><th>quartiles</th><th>range</th><th>change per repetition</th>"
      "<th>ρ pooled</th><th>ρ within people</th></tr>\n";
  for (const MetricStudy& m : study.metrics) {
    if (m.all.count == 0) continue;
    out += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{} … {}</td><td>{} … {}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
        heading(m), figure(m.all.median), figure(m.all.lower), figure(m.all.upper), figure(m.all.least),
        figure(m.all.most), with_range(m.trend.slope, slope), with_range(m.trend.pooled, rho),
        with_range(m.trend.within, rho));
  }
  return out + "</table>\n";
}

std::string person_table(const Study& study) {
  std::string out = "<table><tr><th>Metric: median (ρ with repetition)</th>";
  for (std::size_t p = 0; p < study.persons.size(); ++p)
    out += fmt::format("<th><span style=\"color:{}\">●</span> {}</th>", colour(p), escaped(study.persons[p]));
  out += "</tr>\n";
  for (const MetricStudy& m : study.metrics) {
    if (m.all.count == 0) continue;
    out += "<tr><td>" + heading(m) + "</td>";
    for (std::size_t p = 0; p < study.persons.size(); ++p)
      out += fmt::format("<td>{} <small>({})</small></td>", figure(m.by_person[p].median), rho(m.person_rho[p]));
    out += "</tr>\n";
  }
  return out + "</table>\n";
}

/// What the durations say, in words, with the figures.
std::string learning(const Study& study) {
  const MetricStudy& m = study.metrics.front();
  if (m.by_repetition.size() < 2 || m.all.count == 0) return "";
  const Spread &first = m.by_repetition.front(), &last = m.by_repetition.back();
  const auto better = std::count_if(m.person_rho.begin(), m.person_rho.end(), [](double own) { return own < 0; });
  return fmt::format(
      "<p class=\"lead\">Duration changes by <b>{}</b> s with each repetition (each person with an offset of their "
      "own). "
      "Spearman's ρ between repetition and duration: {} over all attempts, {} within people. In brackets: the range "
      "when "
      "each person in turn is left out. Median of the first attempts {} s, of the last {} s. {} of {} people became "
      "quicker (ρ &lt; 0).</p>\n",
      with_range(m.trend.slope, slope), with_range(m.trend.pooled, rho), with_range(m.trend.within, rho),
      figure(first.median), figure(last.median), better, study.persons.size());
}

constexpr const char* kStyle =
    "body{font:15px/1.5 system-ui,sans-serif;max-width:78em;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;margin:.5em 0}th,td{text-align:left;padding:.2em .7em;border-bottom:1px solid #ddd;"
    "font-variant-numeric:tabular-nums}figure{display:inline-block;width:24.5em;margin:.5em;vertical-align:top}"
    "figcaption{font-weight:600}svg{width:100%;height:auto}svg text{font:11px system-ui,sans-serif;fill:#555}"
    ".grid{stroke:#e4e4e4;fill:none}.band{fill:#0072b2;opacity:.12}.median{stroke:#333;stroke-width:1.6;fill:none}"
    "small{color:#666;white-space:nowrap}.lead{font-size:1.1em}";

}  // namespace

std::string trials_html(const Study& study, const std::string& title, const std::vector<std::string>& remarks) {
  std::string page = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\">\n<title>{0}</title><style>{1}</style>\n<h1>{0}</h1>\n<p>{2} attempts of {3} "
      "people.</p>\n",
      escaped(title), kStyle, study.attempts.size(), study.persons.size());
  page += learning(study);
  for (const std::string& remark : remarks) page += "<p>" + escaped(remark) + "</p>\n";
  page += "<h2>With repetition</h2>\n<p>A dot is an attempt, a colour a person (";
  for (std::size_t p = 0; p < study.persons.size(); ++p)
    page +=
        fmt::format("{}<span style=\"color:{}\">●</span> {}", p > 0 ? ", " : "", colour(p), escaped(study.persons[p]));
  page += "); the line runs through the medians, the band between the quartiles.</p>\n";
  for (const MetricStudy& m : study.metrics)
    if (m.all.count > 0) page += drawing(study, m);
  page += "<h2>Spread and trend</h2>\n" + spread_table(study);
  page += "<h2>People</h2>\n" + person_table(study);
  return page + "</html>\n";
}

}  // namespace trocar::reports
