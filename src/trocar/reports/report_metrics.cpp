#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/reports/export.hpp>
#include <trocar/reports/labels.hpp>
#include <trocar/reports/report_data.hpp>
#include <trocar/reports/report_metrics.hpp>
#include <trocar/reports/report_svg.hpp>

namespace trocar::reports {
namespace {

struct Row {
  const char* key;  ///< within a hand's metrics
  const char* name;
  const char* unit;
  double scale;
  const char* better;  ///< which way is better, if that is known
};

constexpr Row kRows[] = {
    {"path_m", "Instrument path length", "mm", 1000, "lower"},
    {"economy", "Economy of motion", "", 1, "higher"},
    {"depth_m", "Travel along the shaft", "mm", 1000, "lower"},
    {"depth_reversals_near_target", "Reversals near a target", "", 1, "lower"},
    {"angular_path_rad", "Rotation", "rad", 1, "lower"},
    {"ldlj", "Smoothness, log dimensionless jerk", "", 1, "closer to 0"},
    {"sparc", "Smoothness, spectral arc length", "", 1, "closer to 0"},
    {"movements", "Number of movements", "", 1, "lower"},
    {"idle_fraction", "Idle time", "%", 100, ""},
    {"mean_speed_m_per_s", "Mean speed", "mm/s", 1000, ""},
    {"peak_speed_m_per_s", "Peak speed", "mm/s", 1000, ""},
    {"forces/pull/max_N", "Largest pull", "N", 1, "lower"},
    {"forces/pull/rms_N", "Pull, root mean square", "N", 1, ""},
    {"forces/pull/impulse_Ns", "Pull, force times time", "N s", 1, "lower"},
    {"forces/pull/above_limit_s", "Time with pull above its limit", "s", 1, "lower"},
    {"forces/pinch/max_N", "Largest pinch", "N", 1, "lower"},
    {"forces/pinch/above_limit_s", "Time with pinch above its limit", "s", 1, "lower"},
    {"forces/contact/max_N", "Largest contact force", "N", 1, "lower"},
    {"forces/contact/impulse_Ns", "Contact, force times time", "N s", 1, "lower"},
};
constexpr Row kWhole[] = {
    {"exercise_seconds", "Duration", "s", 1, "lower"},
    {"metrics/camera/path_m", "Endoscope path length", "mm", 1000, "lower"},
    {"metrics/camera/horizon_mean_deg", "Horizon error, mean", "°", 1, "lower"},
    {"metrics/camera/horizon_p95_deg", "Horizon error, 95th percentile", "°", 1, "lower"},
    {"metrics/camera/on_target_share", "Time on target", "%", 100, "higher"},
    {"metrics/camera/lens_touches", "Lens touches", "", 1, "lower"},
    {"metrics/camera/seconds_per_target", "Time per target, mean", "s", 1, "lower"},
    {"metrics/camera/slowest_target_s", "Time per target, longest", "s", 1, "lower"},
    {"metrics/bimanual/path_ratio", "Shorter path to longer path", "", 1, ""},
    {"metrics/bimanual/simultaneous_fraction", "Both hands moving", "%", 100, "higher"},
    {"metrics/bimanual/speed_correlation", "Correlation of speeds", "", 1, ""},
};

constexpr const char* kNothing = "–";

std::string number(std::optional<double> v, double scale) {
  if (!v || !std::isfinite(*v)) return kNothing;
  const double x = *v * scale;
  if (x == std::round(x) && std::fabs(x) < 1e6) return fmt::format("{:.0f}", x);
  return std::fabs(x) >= 100  ? fmt::format("{:.0f}", x)
         : std::fabs(x) >= 10 ? fmt::format("{:.1f}", x)
                              : fmt::format("{:.2f}", x);
}

/// Median and range of the attempts before this one.
std::string spread(std::vector<double> values, double scale) {
  if (values.empty()) return kNothing;
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  const double median = n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
  if (n == 1) return number(median, scale);
  return tr("{} ({} to {})", number(median, scale), number(values.front(), scale), number(values.back(), scale));
}

struct Earlier {
  std::vector<Json> results;
  std::vector<double> all(const std::string& pointer) const {
    std::vector<double> out;
    for (const Json& r : results)
      if (const auto v = number_in(r, pointer); v && std::isfinite(*v)) out.push_back(*v);
    return out;
  }
};

/// A row of the table: each hand's, all together, what there was before, the demonstration's.
class Rows {
 public:
  Rows(const Report& report, const Earlier& earlier, const std::optional<Json>& scripted, std::size_t hands)
      : m_report(report), m_earlier(earlier), m_scripted(scripted), m_hands(hands) {}

  void add(const Row& row, const std::string& pointer, bool per_hand) {
    Json cells = Json::array();
    for (std::size_t h = 0; h < m_hands; ++h)
      cells.push_back(per_hand ? number(number_in(m_report.result, tr("/metrics/hands/{}/{}", h, row.key)), row.scale)
                               : "");
    cells.push_back(number(number_in(m_report.result, pointer), row.scale));
    if (!m_earlier.results.empty()) cells.push_back(spread(m_earlier.all(pointer), row.scale));
    if (m_scripted) cells.push_back(number(number_in(*m_scripted, pointer), row.scale));
    const bool empty = std::all_of(cells.begin(), cells.end(), [](const Json& c) { return c == "" || c == kNothing; });
    if (empty) return;  // this scene has nothing to measure for it
    m_rows.push_back(
        {{"name", tr(row.name)}, {"unit", row.unit}, {"cells", cells}, {"better", *row.better ? tr(row.better) : ""}});
  }
  Json list() && { return std::move(m_rows); }

 private:
  const Report& m_report;
  const Earlier& m_earlier;
  const std::optional<Json>& m_scripted;
  std::size_t m_hands;
  Json m_rows = Json::array();
};

struct Curve {
  const char *id, *title, *unit;
  std::vector<double> values;
};

Json curve(const Report& r, const Curve& c, int emphasised) {
  Plot p;
  p.id = c.id;
  p.title = tr("{} over attempts", c.title);
  p.x_label = tr("Attempt");
  p.y_label = *c.unit ? fmt::format("{} [{}]", c.title, c.unit) : c.title;
  p.points = p.whole_x = true;
  p.emphasised = emphasised;
  p.width = 380;
  p.height = 210;
  Series s{c.title, {}, c.values, 0};
  double first = std::numeric_limits<double>::quiet_NaN(), last = first;
  for (std::size_t i = 0; i < c.values.size(); ++i) {
    s.x.push_back(double(i + 1));
    if (!std::isfinite(c.values[i])) continue;
    if (!std::isfinite(first)) first = c.values[i];
    last = c.values[i];
  }
  if (!std::isfinite(first)) return nullptr;
  p.description = tr("From {:.4g} at first to {:.4g} now, {} attempts.", first, last, c.values.size());
  if (std::string_view(c.id) == "curve-score")
    if (const auto mark = number_in(r.result, "/assessment/score/pass_mark")) p.levels = {{*mark, tr("Pass mark")}};
  p.series.push_back(std::move(s));
  return {{"drawing", svg(p)}, {"title", c.title}};
}

}  // namespace

Json metrics_data(const Report& r) {
  if (!r.result.contains("metrics") || !r.result["metrics"].is_object()) return nullptr;
  Earlier earlier;
  for (const training::Attempt& a : r.history)
    if (a.uuid != r.attempt.uuid) earlier.results.push_back(result_of(a));
  std::optional<Json> scripted;
  if (r.scripted) scripted = result_of(*r.scripted);
  Json hands = Json::array();
  if (const Json& list = part_of(r.result["metrics"], "hands"); list.is_array())
    for (const Json& hand : list) hands.push_back(in_plain_words(text_in(hand, "name"), true));

  Rows rows(r, earlier, scripted, hands.size());
  for (const Row& row : kWhole) rows.add(row, std::string("/") + row.key, false);
  if (!hands.empty())  // without instruments all of these would be 0
    for (const Row& row : kRows) rows.add(row, std::string("/metrics/both/") + row.key, true);
  if (scripted) rows.add({"", "Score", "of 100 points", 1, "higher"}, "/assessment/score/total", false);
  return {{"hands", hands},
          {"before", earlier.results.empty() ? "" : std::to_string(earlier.results.size())},
          {"scripted", scripted ? std::to_string(r.scripted->number) : ""},
          {"rows", std::move(rows).list()}};
}

namespace {

bool has_hands(const Json& result) {
  const Json& hands = part_of(part_of(result, "metrics"), "hands");
  return hands.is_array() && !hands.empty();
}

}  // namespace

Json learning_data(const Report& r) {
  if (r.history.size() < 2) return nullptr;
  const double none = std::numeric_limits<double>::quiet_NaN();
  Curve curves[] = {{"curve-score", tr("Score"), tr("points"), {}},
                    {"curve-time", tr("Duration"), "s", {}},
                    {"curve-path", tr("Instrument path length"), "mm", {}}};
  int here = -1;
  for (std::size_t i = 0; i < r.history.size(); ++i) {
    const training::Attempt& a = r.history[i];
    const Json result = result_of(a);
    curves[0].values.push_back(a.score.value_or(none));
    // An attempt that did not reach its end has no time to compare.
    const Json::json_pointer finished("/assessment/finished");
    const bool whole = result.contains(finished) && result[finished] == true;
    curves[1].values.push_back(whole ? number_in(result, "/exercise_seconds").value_or(none) : none);
    curves[2].values.push_back(
        whole && has_hands(result) ? 1000 * number_in(result, "/metrics/both/path_m").value_or(none) : none);
    if (a.uuid == r.attempt.uuid) here = int(i);
  }
  Json drawn = Json::array();
  for (const Curve& c : curves)
    if (Json one = curve(r, c, here); !one.is_null()) drawn.push_back(std::move(one));
  return {{"attempts", std::to_string(r.history.size())}, {"curves", drawn}};
}

}  // namespace trocar::reports
