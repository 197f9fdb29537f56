#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

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

/// Of each person, in the order of the attempts.
std::vector<Points> by_person(const Points& all, std::size_t persons) {
  std::vector<Points> own(persons);
  for (std::size_t i = 0; i < all.value.size(); ++i) {
    own[all.person[i]].repetition.push_back(all.repetition[i]);
    own[all.person[i]].value.push_back(all.value[i]);
  }
  return own;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / double(values.size());
}

constexpr auto kNobody = std::size_t(-1);

/// A figure of all persons together, or without one of them: numerator over denominator, each a sum over persons.
class SumOverPersons {
 public:
  void add(double above, double below) {
    m_above.push_back(above);
    m_below.push_back(below);
  }
  double without(std::size_t person) const {
    double above = 0, below = 0;
    for (std::size_t p = 0; p < m_above.size(); ++p)
      if (p != person) above += m_above[p], below += m_below[p];
    return below > 0 ? above / below : kNoMetric;
  }

 private:
  std::vector<double> m_above, m_below;
};

/// Slope common to all persons, each with an offset of its own.
SumOverPersons slopes(const std::vector<Points>& persons) {
  SumOverPersons sum;
  for (const Points& own : persons) {
    double xx = 0, xy = 0;
    const double x0 = own.value.empty() ? 0 : mean(own.repetition), y0 = own.value.empty() ? 0 : mean(own.value);
    for (std::size_t i = 0; i < own.value.size(); ++i) {
      xx += (own.repetition[i] - x0) * (own.repetition[i] - x0);
      xy += (own.repetition[i] - x0) * (own.value[i] - y0);
    }
    sum.add(xy, xx);
  }
  return sum;
}

/// Mean of each person's own rho.
SumOverPersons rhos_within(const std::vector<double>& person_rho) {
  SumOverPersons sum;
  for (const double rho : person_rho) std::isnan(rho) ? sum.add(0, 0) : sum.add(rho, 1);
  return sum;
}

/// Indices by ascending values, equal ones as they come.
std::vector<std::size_t> order_of(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  return order;
}

/// 1-based ranks of the values in this order; equal values share the mean of theirs. Those that are not in it get none.
std::vector<double> ranks(std::span<const double> values, const std::vector<std::size_t>& order) {
  std::vector<double> rank(values.size());
  for (std::size_t from = 0; from < order.size();) {
    std::size_t to = from;
    while (to < order.size() && values[order[to]] == values[order[from]]) ++to;
    for (std::size_t i = from; i < to; ++i) rank[order[i]] = 0.5 * double(from + 1 + to);
    from = to;
  }
  return rank;
}

/// Rho over all attempts. Both columns are sorted once, so that leaving each person out in turn stays affordable.
class PooledRho {
 public:
  explicit PooledRho(const Points& all)
      : m_all(all), m_by_repetition(order_of(all.repetition)), m_by_value(order_of(all.value)) {}

  double without(std::size_t person) const {
    const auto left = [&](const std::vector<std::size_t>& order) {
      std::vector<std::size_t> some;
      for (const std::size_t i : order)
        if (m_all.person[i] != person) some.push_back(i);
      return some;
    };
    const std::vector<std::size_t> by_repetition = left(m_by_repetition), by_value = left(m_by_value);
    if (by_value.size() < 3) return kNoMetric;
    std::vector<double> a = ranks(m_all.repetition, by_repetition), b = ranks(m_all.value, by_value);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      if (m_all.person[i] != person) a[kept] = a[i], b[kept] = b[i], ++kept;
    return pearson(std::span(a).first(kept), std::span(b).first(kept));
  }

 private:
  const Points& m_all;
  std::vector<std::size_t> m_by_repetition, m_by_value;
};

template <class Figure>
Ranged ranged(const Figure& figure, std::size_t persons) {
  Ranged r;
  r.value = figure.without(kNobody);
  if (persons < 3) return r;
  for (std::size_t p = 0; p < persons; ++p) {
    const double value = figure.without(p);
    if (!(r.low <= value)) r.low = value;
    if (!(r.high >= value)) r.high = value;
  }
  return r;
}

/// @param person_of  (attempts) place in Study::persons
MetricStudy metric_study(const Study& study, const std::vector<std::size_t>& person_of, const MetricColumn& column) {
  MetricStudy m;
  m.column = &column;
  Points points;
  std::map<int, std::vector<double>> repetitions;
  const std::size_t persons = study.persons.size();
  int most = 0;
  for (std::size_t i = 0; i < study.attempts.size(); ++i) {
    const StudyAttempt& a = study.attempts[i];
    most = std::max(most, a.repetition);
    const double value = column.get(a.metrics);
    if (std::isnan(value)) continue;
    points.repetition.push_back(double(a.repetition));
    points.value.push_back(value);
    points.person.push_back(person_of[i]);
    repetitions[a.repetition].push_back(value);
  }
  m.all = spread_of(points.value);
  const std::vector<Points> own = by_person(points, persons);
  for (const Points& p : own) {
    m.by_person.push_back(spread_of(p.value));
    m.person_rho.push_back(spearman(p.repetition, p.value));
  }
  m.by_repetition.resize(std::size_t(most));
  for (auto& [repetition, values] : repetitions)
    m.by_repetition[std::size_t(repetition) - 1] = spread_of(std::move(values));
  m.trend.slope = ranged(slopes(own), persons);
  m.trend.pooled = ranged(PooledRho(points), persons);
  m.trend.within = ranged(rhos_within(m.person_rho), persons);
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
  return pearson(ranks(a, order_of(a)), ranks(b, order_of(b)));
}

Study study_of(std::vector<StudyAttempt> attempts) {
  Study study;
  study.attempts = std::move(attempts);
  std::map<std::string_view, std::size_t> place;
  std::vector<std::size_t> person_of;
  for (StudyAttempt& a : study.attempts) {
    a.repetition = std::max(a.repetition, 1);
    const auto [person, is_new] = place.emplace(a.person, study.persons.size());
    if (is_new) study.persons.push_back(a.person);
    person_of.push_back(person->second);
  }
  for (const MetricColumn& column : kColumns) study.metrics.push_back(metric_study(study, person_of, column));
  return study;
}

}  // namespace trocar::training
