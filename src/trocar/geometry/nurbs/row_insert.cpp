#include <algorithm>
#include <cmath>

#include <trocar/geometry/nurbs/row.hpp>

namespace trocar::geometry::nurbs {
namespace {

constexpr double kSameKnot = 1e-12;  // of the domain's extent

// Control point of function i; periodic rows continue for ever.
const Vec4d& point_at(const Row& row, int i) {
  if (!row.knots.periodic) return row.points[i];
  const int n = row.knots.points();
  return row.points[((i % n) + n) % n];
}

// Function span - degree is the first that changes; one more function than before.
Row inserted_once(const Row& row, double u) {
  const Knots& old = row.knots;
  const int p = old.degree, span = span_of(old, u), repeats = multiplicity(old, u), n = old.points();
  Row result;
  result.knots = old;
  if (old.periodic) {
    std::vector<double> round = round_of(old);
    round.insert(round.begin() + (span + 1 - p), u);
    result.knots = periodic(p, round, old.extent());
  } else {
    result.knots.values.insert(result.knots.values.begin() + span + 1, u);
  }
  result.points.resize(static_cast<std::size_t>(n + 1));
  const int first = old.periodic ? span - p + 1 : 0;
  for (int i = first; i <= first + n; ++i) {
    Vec4d& target = result.points[old.periodic ? i % (n + 1) : i];
    if (i <= span - p)
      target = point_at(row, i);
    else if (i > span - repeats)
      target = point_at(row, i - 1);
    else {
      const double start = old.values[i], stop = old.values[i + p];
      target = blend(point_at(row, i - 1), point_at(row, i), (u - start) / (stop - start));
    }
  }
  return result;
}

bool is_end(const Knots& knots, double u) { return !knots.periodic && (u == knots.start() || u == knots.end()); }

}  // namespace

double distance(Vec4d a, Vec4d b) noexcept {
  const Vec4d d = a - b;
  return std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z + d.w * d.w);
}

double snapped(const Knots& knots, double u) noexcept {
  const double slack = kSameKnot * knots.extent();
  u = into_domain(knots, u);
  const int span = span_of(knots, u);
  if (u - knots.values[span] <= slack) return knots.values[span];
  if (knots.values[span + 1] - u <= slack) return into_domain(knots, knots.values[span + 1]);
  return u;
}

Row inserted(const Row& row, double u, int times) {
  u = snapped(row.knots, u);
  Row result = row;
  if (is_end(row.knots, u)) return result;
  const int most = std::min(times, row.knots.degree - multiplicity(row.knots, u));
  for (int k = 0; k < most; ++k) result = inserted_once(result, u);
  return result;
}

Row refined(const Row& row, const std::vector<double>& more) {
  Row result = row;
  for (double u : more) result = inserted(result, u, 1);
  return result;
}

Row opened(const Row& row, double u) {
  if (!row.knots.periodic) return row;
  u = snapped(row.knots, u);
  const int p = row.knots.degree;
  const Row whole = inserted(row, u, p);
  const std::vector<double> round = round_of(whole.knots);
  const int n = whole.knots.points();
  const int at = static_cast<int>(std::lower_bound(round.begin(), round.end(), u) - round.begin());
  Row result;
  std::vector<double> inside;
  for (int i = at + p; i < at + n; ++i) inside.push_back(round[i % n] + (i < n ? 0.0 : whole.knots.extent()));
  const double stop = u == whole.knots.start() ? whole.knots.end() : u + whole.knots.extent();
  result.knots = clamped(p, u, inside, stop);
  // The knots u stand at places at + p .. at + 2 p - 1 of the values: the curve there is control point at + p - 1.
  for (int i = 0; i <= n; ++i) result.points.push_back(whole.points[(at + p - 1 + i) % n]);
  return result;
}

Row part(const Row& row, double a, double b) {
  const int p = row.knots.degree;
  a = snapped(row.knots, a), b = snapped(row.knots, b);
  const Row whole = inserted(inserted(row, a, p), b, p);
  const auto& t = whole.knots.values;
  const int from = static_cast<int>(std::upper_bound(t.begin(), t.end(), a) - t.begin());  // behind the last a
  const int to = static_cast<int>(std::lower_bound(t.begin(), t.end(), b) - t.begin());    // the first b
  Row result;
  result.knots = clamped(p, a, {t.begin() + from, t.begin() + to}, b);
  const int first = from - p - 1;
  result.points.assign(whole.points.begin() + first, whole.points.begin() + first + result.knots.points());
  return result;
}

Row joined(const Row& a, const Row& b) {
  const int p = a.knots.degree;
  const double shift = a.knots.end() - b.knots.start();
  std::vector<double> inside(a.knots.values.begin() + p + 1, a.knots.values.end() - p - 1);
  inside.insert(inside.end(), static_cast<std::size_t>(p), a.knots.end());
  for (int i = p + 1; i < b.knots.functions(); ++i) inside.push_back(b.knots.values[i] + shift);
  Row result{clamped(p, a.knots.start(), inside, b.knots.end() + shift), a.points};
  result.points.insert(result.points.end(), b.points.begin() + 1, b.points.end());
  return result;
}

Row reversed(const Row& row) {
  Row result = row;
  const double sum = row.knots.start() + row.knots.end();
  std::reverse(result.points.begin(), result.points.end());
  if (!row.knots.periodic) {
    std::reverse(result.knots.values.begin(), result.knots.values.end());
    for (double& value : result.knots.values) value = sum - value;
    std::fill(result.knots.values.begin(), result.knots.values.begin() + row.knots.degree + 1, row.knots.start());
    std::fill(result.knots.values.end() - row.knots.degree - 1, result.knots.values.end(), row.knots.end());
    return result;
  }
  // The domain starts at the repeats of its start again, which now come last in a period.
  const int repeats = multiplicity(row.knots, row.knots.start()), n = row.knots.points(), p = row.knots.degree;
  std::vector<double> round(static_cast<std::size_t>(repeats), row.knots.start());
  const std::vector<double> old = round_of(row.knots);
  for (int i = n - 1; i >= repeats; --i) round.push_back(sum - old[i]);
  result.knots = periodic(p, round, row.knots.extent());
  // Function i lives on the places i .. i + p + 1 of the values; mirrored it is number p + n + repeats - 2 - i.
  for (int j = 0; j < n; ++j) result.points[j] = row.points[(p + n + repeats - 2 - j) % n];
  return result;
}

}  // namespace trocar::geometry::nurbs
