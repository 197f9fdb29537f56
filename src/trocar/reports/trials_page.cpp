#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/reports/page_template.hpp>
#include <trocar/reports/report_svg.hpp>
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
  return tr("{} <small>({} … {})</small>", shown(r.value), shown(r.low), shown(r.high));
}

std::string heading(const MetricStudy& m) {
  const std::string unit = m.column->unit;
  return m.column->title + (unit.empty() ? "" : " [" + unit + "]");
}

// --- drawings ---

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
  return fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\">\n{}{}{}</svg>", a.width, a.height, frame(a), band(m, a),
                     points(study, m, a));
}

// --- the page's data ---

Json metric_data(const Study& study, const MetricStudy& m) {
  Json people = Json::array();
  for (std::size_t p = 0; p < study.persons.size(); ++p)
    people.push_back({{"median", figure(m.by_person[p].median)}, {"rho", rho(m.person_rho[p])}});
  return {{"heading", heading(m)},
          {"drawing", drawing(study, m)},
          {"median", figure(m.all.median)},
          {"lower", figure(m.all.lower)},
          {"upper", figure(m.all.upper)},
          {"least", figure(m.all.least)},
          {"most", figure(m.all.most)},
          {"slope", with_range(m.trend.slope, slope)},
          {"pooled", with_range(m.trend.pooled, rho)},
          {"within", with_range(m.trend.within, rho)},
          {"by_person", people}};
}

/// What the durations say, for a sentence with figures; null where nothing was repeated.
Json learning(const Study& study) {
  const MetricStudy& m = study.metrics.front();
  if (m.by_repetition.size() < 2 || m.all.count == 0) return nullptr;
  const auto quicker = std::count_if(m.person_rho.begin(), m.person_rho.end(), [](double own) { return own < 0; });
  return {{"slope", with_range(m.trend.slope, slope)},     {"pooled", with_range(m.trend.pooled, rho)},
          {"within", with_range(m.trend.within, rho)},     {"first", figure(m.by_repetition.front().median)},
          {"last", figure(m.by_repetition.back().median)}, {"quicker", std::to_string(quicker)}};
}

}  // namespace

std::string trials_html(const Study& study, const std::string& title, const std::vector<std::string>& remarks) {
  Json persons = Json::array(), metrics = Json::array();
  for (std::size_t p = 0; p < study.persons.size(); ++p)
    persons.push_back({{"name", study.persons[p]}, {"colour", colour(p)}, {"first", p == 0}});
  for (const MetricStudy& m : study.metrics)
    if (m.all.count > 0) metrics.push_back(metric_data(study, m));
  return fill(page_text("study.html"), {{"title", title},
                                        {"attempts", std::to_string(study.attempts.size())},
                                        {"people", std::to_string(study.persons.size())},
                                        {"learning", learning(study)},
                                        {"remarks", remarks},
                                        {"persons", persons},
                                        {"metrics", metrics}});
}

}  // namespace trocar::reports
