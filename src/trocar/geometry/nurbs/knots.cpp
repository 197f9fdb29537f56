#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/nurbs/knots.hpp>

namespace trocar::geometry::nurbs {
namespace {

// How far repeats of a period may be off, in units of the largest knot or of the period: what sums of doubles lose.
constexpr double kPeriodSlack = 1e-12;

std::string order_fault(const std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) return tr("knot {} is not a number", i);
    if (i > 0 && values[i] < values[i - 1])
      return tr("knot {} = {} lies below knot {} = {}", i, values[i], i - 1, values[i - 1]);
  }
  return {};
}

std::string end_fault(const Knots& k) {
  for (int i = 1; i <= k.degree; ++i) {
    if (k.values[i] != k.values[0])
      return tr("the first {} knots of a clamped spline are equal; knot {} is {}, not {}", k.degree + 1, i, k.values[i],
                k.values[0]);
    const std::size_t last = k.values.size() - 1;
    if (k.values[last - i] != k.values[last])
      return tr("the last {} knots of a clamped spline are equal; knot {} is {}, not {}", k.degree + 1, last - i,
                k.values[last - i], k.values[last]);
  }
  return {};
}

std::string period_fault(const Knots& k) {
  if (!(k.values[k.degree - 1] < k.values[k.degree]))
    return tr("the repeats of a periodic spline's first knot stand inside of its domain; knot {} is {}, too",
              k.degree - 1, k.values[k.degree]);
  const int n = k.points();
  const double slack = kPeriodSlack * std::max({k.extent(), std::fabs(k.values.front()), std::fabs(k.values.back())});
  for (int i = 0; i + n < static_cast<int>(k.values.size()); ++i)
    if (!(std::fabs(k.values[i + n] - k.values[i] - k.extent()) <= slack))
      return tr("knot {} = {} is not one period of {} behind knot {} = {}", i + n, k.values[i + n], k.extent(), i,
                k.values[i]);
  return {};
}

std::string repeat_fault(const Knots& k) {
  int first = k.degree + (k.periodic ? 0 : 1);
  for (int i = first; i < k.functions(); ++i) {
    if (k.values[i] != k.values[first]) first = i;
    if (i - first + 1 > k.degree)
      return tr("knot {} is repeated more than {} times, the degree", k.values[i], k.degree);
  }
  if (!k.periodic && k.values[k.degree + 1] == k.start())
    return tr("the first knot is repeated more than {} times", k.degree + 1);
  if (!k.periodic && k.values[k.functions() - 1] == k.end())
    return tr("the last knot is repeated more than {} times", k.degree + 1);
  return {};
}

}  // namespace

std::string fault_in(const Knots& k) {
  if (k.degree < 1 || k.degree > kHighestDegree)
    return tr("a degree from 1 to {} expected, got {}", kHighestDegree, k.degree);
  const int least = k.periodic ? 3 * k.degree + 2 : 2 * k.degree + 2;
  if (static_cast<int>(k.values.size()) < least)
    return tr("at least {} knots expected for degree {}, got {}", least, k.degree, k.values.size());
  if (std::string fault = order_fault(k.values); !fault.empty()) return fault;
  if (!(k.extent() > 0.0)) return "the knots span no domain";
  if (std::string fault = k.periodic ? period_fault(k) : end_fault(k); !fault.empty()) return fault;
  return repeat_fault(k);
}

void require_valid(const Knots& knots, const char* who) {
  if (const std::string fault = fault_in(knots); !fault.empty()) throw std::invalid_argument(who + (": " + fault));
}

double into_domain(const Knots& knots, double u) noexcept {
  const double start = knots.start(), end = knots.end();
  if (!knots.periodic) return std::clamp(u, start, end);
  const double wrapped = u - std::floor((u - start) / (end - start)) * (end - start);
  return wrapped < end ? std::max(wrapped, start) : start;
}

int span_of(const Knots& knots, double u) noexcept {
  const auto first = knots.values.begin() + knots.degree, last = knots.values.begin() + knots.functions();
  int s = static_cast<int>(std::upper_bound(first, last, u) - knots.values.begin()) - 1;
  if (s < knots.degree) s = knots.degree;
  while (s > knots.degree && knots.values[s + 1] == knots.values[s]) --s;  // at the end of the domain
  while (knots.values[s + 1] == knots.values[s]) ++s;                      // at its start, repeated
  return s;
}

int multiplicity(const Knots& knots, double u) noexcept {
  const double wished = knots.periodic && u == knots.end() ? knots.start() : u;
  const auto first = knots.values.begin() + (knots.periodic ? knots.degree : 0);
  const auto last = knots.periodic ? knots.values.begin() + knots.functions() : knots.values.end();
  return static_cast<int>(std::count(first, last, wished));
}

std::vector<Knot> distinct(const Knots& knots) {
  std::vector<Knot> result;
  const int first = knots.periodic ? knots.degree : 0;
  const int last = knots.periodic ? knots.functions() : static_cast<int>(knots.values.size());
  for (int i = first; i < last; ++i) {
    if (result.empty() || result.back().value != knots.values[i]) result.push_back({knots.values[i], 0});
    ++result.back().multiplicity;
  }
  return result;
}

std::vector<double> breaks(const Knots& knots) {
  std::vector<double> result;
  for (const Knot& knot : distinct(knots)) result.push_back(knot.value);
  if (knots.periodic) result.push_back(knots.end());
  return result;
}

std::vector<double> greville(const Knots& knots) {
  std::vector<double> means(static_cast<std::size_t>(knots.points()));
  for (int i = 0; i < knots.points(); ++i) {
    double sum = 0.0;
    for (int k = 1; k <= knots.degree; ++k) sum += knots.values[i + k];
    means[i] = sum / knots.degree;
  }
  if (!knots.periodic) means.front() = knots.start(), means.back() = knots.end();  // not a rounding beside them
  return means;
}

Knots clamped_uniform(int degree, int points) {
  std::vector<double> inside;
  const int spans = points - degree;
  for (int i = 1; i < spans; ++i) inside.push_back(i / double(spans));
  if (spans < 1)
    throw std::invalid_argument(
        tr("clamped_uniform: at least {} control points expected for degree {}, got {}", degree + 1, degree, points));
  return clamped(degree, 0.0, inside, 1.0);
}

Knots clamped(int degree, double start, const std::vector<double>& inside, double end) {
  Knots knots{degree, false, {}};
  knots.values.assign(static_cast<std::size_t>(std::max(degree, 0) + 1), start);
  knots.values.insert(knots.values.end(), inside.begin(), inside.end());
  knots.values.insert(knots.values.end(), static_cast<std::size_t>(std::max(degree, 0) + 1), end);
  require_valid(knots, "clamped");
  return knots;
}

Knots periodic_uniform(int degree, int points) {
  std::vector<double> round;
  for (int i = 0; i < points; ++i) round.push_back(i / double(points));
  return periodic(degree, round, 1.0);
}

Knots periodic(int degree, const std::vector<double>& round, double period) {
  const int n = static_cast<int>(round.size());
  if (n < degree + 1)
    throw std::invalid_argument(
        tr("periodic: at least {} control points expected for degree {}, got {}", degree + 1, degree, n));
  Knots knots{degree, true, {}};
  for (int i = -degree; i <= n + degree; ++i) {
    const int turns = i < 0 ? -1 : i / n;
    knots.values.push_back(round[i - turns * n] + turns * period);
  }
  require_valid(knots, "periodic");
  return knots;
}

std::vector<double> round_of(const Knots& knots) {
  return {knots.values.begin() + knots.degree, knots.values.begin() + knots.functions()};
}

Knots on_domain(const Knots& knots, double start, double end) {
  Knots moved = knots;
  const double from = knots.start(), scale = (end - start) / knots.extent(), stop = knots.end();
  for (double& value : moved.values) value = value == stop ? end : start + scale * (value - from);
  require_valid(moved, "on_domain");
  return moved;
}

}  // namespace trocar::geometry::nurbs
