#include <algorithm>
#include <cmath>

#include <trocar/training/metrics/metrics_parts.hpp>
#include <trocar/training/metrics/study.hpp>

namespace trocar::training {
namespace {

#define TROCAR_COLUMN(key, title, unit, better, expression)                       \
  MetricColumn {                                                                  \
    key, title, unit, better, [](const Metrics& m) { return double(expression); } \
  }

constexpr MetricColumn kColumns[] = {
    TROCAR_COLUMN("duration_s", "Duration", "s", -1, m.duration),
    TROCAR_COLUMN("time_s", "Time from the first motion", "s", -1, m.time),
    TROCAR_COLUMN("path_m", "Path length", "m", -1, m.both.path),
    TROCAR_COLUMN("economy", "Economy of path", "", 1, m.both.economy),
    TROCAR_COLUMN("depth_m", "Travel along the shaft", "m", -1, m.both.depth),
    TROCAR_COLUMN("depth_reversals", "Turns along the shaft", "", -1, m.both.depth_reversals),
    TROCAR_COLUMN("depth_reversals_near_target", "Turns along the shaft near a target", "", -1,
                  m.both.depth_reversals_near),
    TROCAR_COLUMN("angular_path_rad", "Angular path", "rad", -1, m.both.angular_path),
    TROCAR_COLUMN("mean_jerk", "Mean jerk", "", -1, m.both.mean_jerk),
    TROCAR_COLUMN("ldlj", "Log dimensionless jerk", "", 1, m.both.ldlj),
    TROCAR_COLUMN("sparc", "Spectral arc length", "", 1, m.both.sparc),
    TROCAR_COLUMN("movements", "Movements", "", -1, m.both.movements),
    TROCAR_COLUMN("idle_fraction", "Idle fraction", "", -1, m.both.idle),
    TROCAR_COLUMN("path_ratio", "Ratio of the hands' paths", "", 0, m.bimanual.ratio),
    TROCAR_COLUMN("simultaneous_fraction", "Both hands move", "", 1, m.bimanual.simultaneous),
    TROCAR_COLUMN("speed_correlation", "Correlation of the hands' speeds", "", 0, m.bimanual.speed_correlation),
    TROCAR_COLUMN("pull_max_N", "Largest pull", "N", -1, m.both.forces[kPull].max),
    TROCAR_COLUMN("pull_mean_nonzero_N", "Mean pull while pulling", "N", -1, m.both.forces[kPull].mean_nonzero),
    TROCAR_COLUMN("pull_above_limit_s", "Time of too much pull", "s", -1, m.both.forces[kPull].above),
    TROCAR_COLUMN("pinch_max_N", "Largest pinch", "N", -1, m.both.forces[kPinch].max),
    TROCAR_COLUMN("pinch_impulse_Ns", "Pinch over time", "N s", -1, m.both.forces[kPinch].impulse),
    TROCAR_COLUMN("contact_max_N", "Largest contact force", "N", -1, m.both.forces[kContact].max),
    TROCAR_COLUMN("contact_impulse_Ns", "Contact force over time", "N s", -1, m.both.forces[kContact].impulse),
};
#undef TROCAR_COLUMN

/// The attempts of a metric that have it, as columns of numbers.
struct Points {
  std::vector<double> repetition, value;
  std::vector<std::size_t> person;
};

/// Without the person `without` (any number beyond the last: nobody is left out).
Points left_out(const Points& all, std::size_t without) {
  Points p;
  for (std::size_t i = 0; i < all.value.size(); ++i) {
    if (all.person[i] == without) continue;
    p.repetition.push_back(all.repetition[i]);
    p.value.push_back(all.value[i]);
    p.person.push_back(all.person[i]);
  }
  return p;
}

Points of_person(const Points& all, std::size_t person) {
  Points p;
  for (std::size_t i = 0; i < all.value.size(); ++i) {
    if (all.person[i] != person) continue;
    p.repetition.push_back(all.repetition[i]);
    p.value.push_back(all.value[i]);
  }
  return p;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / double(values.size());
}

/// Slope common to all persons, each with an offset of its own.
double slope_within(const Points& all, std::size_t persons) {
  double xx = 0, xy = 0;
  for (std::size_t p = 0; p < persons; ++p) {
    const Points own = of_person(all, p);
    if (own.value.empty()) continue;
    const double x0 = mean(own.repetition), y0 = mean(own.value);
    for (std::size_t i = 0; i < own.value.size(); ++i) {
      xx += (own.repetition[i] - x0) * (own.repetition[i] - x0);
      xy += (own.repetition[i] - x0) * (own.value[i] - y0);
    }
  }
  return xx > 0 ? xy / xx : kNoMetric;
}

double rho_pooled(const Points& all, std::size_t) { return spearman(all.repetition, all.value); }

double rho_within(const Points& all, std::size_t persons) {
  double sum = 0, count = 0;
  for (std::size_t p = 0; p < persons; ++p) {
    const Points own = of_person(all, p);
    const double rho = spearman(own.repetition, own.value);
    if (std::isnan(rho)) continue;
    sum += rho;
    ++count;
  }
  return count > 0 ? sum / count : kNoMetric;
}

Ranged ranged(const Points& all, std::size_t persons, double (*figure)(const Points&, std::size_t)) {
  Ranged r;
  r.value = figure(all, persons);
  if (persons < 3) return r;
  for (std::size_t p = 0; p < persons; ++p) {
    const double value = figure(left_out(all, p), persons);
    if (!(r.low <= value)) r.low = value;
    if (!(r.high >= value)) r.high = value;
  }
  return r;
}

/// 1-based ranks; equal values share the mean of theirs.
std::vector<double> ranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] != values[b] ? values[a] < values[b] : a < b; });
  std::vector<double> rank(values.size());
  for (std::size_t from = 0; from < order.size();) {
    std::size_t to = from;
    while (to < order.size() && values[order[to]] == values[order[from]]) ++to;
    for (std::size_t i = from; i < to; ++i) rank[order[i]] = 0.5 * double(from + 1 + to);
    from = to;
  }
  return rank;
}

MetricStudy metric_study(const Study& study, const MetricColumn& column) {
  MetricStudy m;
  m.column = &column;
  Points points;
  std::size_t repetitions = 0;
  for (const StudyAttempt& a : study.attempts) repetitions = std::max(repetitions, std::size_t(a.repetition));
  std::vector<std::vector<double>> by_person(study.persons.size()), by_repetition(repetitions);
  for (const StudyAttempt& a : study.attempts) {
    const double value = column.get(a.metrics);
    if (std::isnan(value)) continue;
    const auto person =
        std::size_t(std::find(study.persons.begin(), study.persons.end(), a.person) - study.persons.begin());
    points.repetition.push_back(double(a.repetition));
    points.value.push_back(value);
    points.person.push_back(person);
    by_person[person].push_back(value);
    by_repetition[std::size_t(a.repetition) - 1].push_back(value);
  }
  m.all = spread_of(points.value);
  for (std::vector<double>& values : by_person) m.by_person.push_back(spread_of(std::move(values)));
  for (std::vector<double>& values : by_repetition) m.by_repetition.push_back(spread_of(std::move(values)));
  const std::size_t persons = study.persons.size();
  for (std::size_t p = 0; p < persons; ++p) {
    const Points own = of_person(points, p);
    m.person_rho.push_back(spearman(own.repetition, own.value));
  }
  m.trend.slope = ranged(points, persons, slope_within);
  m.trend.pooled = ranged(points, persons, rho_pooled);
  m.trend.within = ranged(points, persons, rho_within);
  return m;
}

}  // namespace

std::span<const MetricColumn> metric_columns() { return kColumns; }

Spread spread_of(std::vector<double> values) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return std::isnan(v); }), values.end());
  std::sort(values.begin(), values.end());
  Spread s;
  s.count = int(values.size());
  if (values.empty()) return s;
  const auto quantile = [&](double q) {
    const double place = q * double(values.size() - 1);
    const auto below = std::size_t(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (place - double(below)) * (values[above] - values[below]);
  };
  s.least = values.front();
  s.lower = quantile(0.25);
  s.median = quantile(0.5);
  s.upper = quantile(0.75);
  s.most = values.back();
  return s;
}

double spearman(std::span<const double> a, std::span<const double> b) {
  if (a.size() < 3) return kNoMetric;
  return pearson(ranks(a), ranks(b));
}

Study study_of(std::vector<StudyAttempt> attempts) {
  Study study;
  study.attempts = std::move(attempts);
  for (StudyAttempt& a : study.attempts) {
    a.repetition = std::max(a.repetition, 1);
    if (std::find(study.persons.begin(), study.persons.end(), a.person) == study.persons.end())
      study.persons.push_back(a.person);
  }
  for (const MetricColumn& column : kColumns) study.metrics.push_back(metric_study(study, column));
  return study;
}

}  // namespace trocar::training
