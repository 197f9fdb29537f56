#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/nurbs/row.hpp>
#include <trocar/numerics/banded.hpp>

namespace trocar::geometry::nurbs {
namespace {

// The polar form of the polynomial that the row is in a span: symmetric, affine in each of the `degree` arguments, and
// the polynomial itself where they are all equal. Arguments that are the knots behind a function's first give its
// control point.  [Ramshaw 1989, Blossoms are polar forms]
Vec4d blossom(const Row& row, int span, const double* arguments) {
  const Knots& k = row.knots;
  const int p = k.degree;
  Vec4d d[kHighestDegree + 1];
  for (int j = 0; j <= p; ++j) d[j] = row.points[k.point_of(span - p + j)];
  for (int r = 1; r <= p; ++r)
    for (int j = p; j >= r; --j) {
      const double start = k.values[span - p + j], stop = k.values[span + 1 + j - r];
      d[j] = blend(d[j - 1], d[j], (arguments[r - 1] - start) / (stop - start));
    }
  return d[p];
}

// Every knot once more, for the degree one above.
Knots elevated_knots(const Knots& k) {
  std::vector<double> more;
  for (const Knot& knot : distinct(k))
    if (k.periodic || (knot.value != k.start() && knot.value != k.end()))
      more.insert(more.end(), static_cast<std::size_t>(knot.multiplicity + 1), knot.value);
  return k.periodic ? periodic(k.degree + 1, more, k.extent()) : clamped(k.degree + 1, k.start(), more, k.end());
}

// A control point of the elevated row is the mean of the polar form over all but one of the knots behind its
// function's first: what makes a polar form of one more argument.
Vec4d elevated_point(const Row& row, const Knots& higher, int function) {
  const int p = row.knots.degree;
  double knots[kHighestDegree + 1];
  std::copy_n(higher.values.begin() + function + 1, p + 1, knots);
  // A span among these knots; where they are all the same knot, one beside it.
  double middle = knots[0];
  for (int i = 0; i < p && middle == knots[0]; ++i) middle = 0.5 * (knots[i] + knots[i + 1]);
  const double inside = into_domain(row.knots, middle), shift = inside - middle;
  const int span = span_of(row.knots, inside);
  Vec4d sum;
  for (int left_out = 0; left_out <= p; ++left_out) {
    double arguments[kHighestDegree + 1];
    int n = 0;
    for (int i = 0; i <= p; ++i)
      if (i != left_out) arguments[n++] = knots[i] + shift;
    sum = sum + blossom(row, span, arguments);
  }
  return (1.0 / (p + 1)) * sum;
}

Row elevated_once(const Row& row) {
  Row result{elevated_knots(row.knots), {}};
  for (int i = 0; i < result.knots.points(); ++i) result.points.push_back(elevated_point(row, result.knots, i));
  return result;
}

// Every knot once less; nothing if too few would be left.
std::optional<Knots> reduced_knots(const Knots& k) {
  std::vector<double> fewer;
  for (const Knot& knot : distinct(k))
    if (k.periodic || (knot.value != k.start() && knot.value != k.end()))
      fewer.insert(fewer.end(), static_cast<std::size_t>(knot.multiplicity - 1), knot.value);
  if (!k.periodic) return clamped(k.degree - 1, k.start(), fewer, k.end());
  if (static_cast<int>(fewer.size()) < k.degree || fewer.front() != k.start()) return {};
  return periodic(k.degree - 1, fewer, k.extent());
}

// Simple knots, which are gone from the lower row.
std::vector<double> simple_knots(const Knots& k) {
  std::vector<double> result;
  for (const Knot& knot : distinct(k))
    if (knot.multiplicity == 1) result.push_back(knot.value);
  return result;
}

// Of each control point of the lower row: its shares in those of the row over the knots that were.
std::vector<std::vector<double>> elevation_columns(const Knots& lower, const std::vector<double>& simple) {
  std::vector<std::vector<double>> columns;
  for (int j = 0; j < lower.points(); ++j) {
    Row unit{lower, std::vector<Vec4d>(static_cast<std::size_t>(lower.points()))};
    unit.points[j].w = 1.0;
    std::vector<double> column;
    for (const Vec4d& p : refined(elevated_once(unit), simple).points) column.push_back(p.w);
    columns.push_back(column);
  }
  return columns;
}

}  // namespace

Row elevated(const Row& row, int times) {
  if (row.knots.degree + times > kHighestDegree)
    throw std::invalid_argument(
        tr("elevated: degree {} asked for, {} is the highest", row.knots.degree + times, kHighestDegree));
  Row result = row;
  for (int k = 0; k < times; ++k) result = elevated_once(result);
  return result;
}

// Least squares over the control points: (E^T E) q = E^T p with E the elevation, simple knots put in again.
std::optional<Removal> reduced(const Row& row) {
  if (row.knots.degree <= 1) return {};
  const std::optional<Knots> lower = reduced_knots(row.knots);
  if (!lower) return {};
  const std::vector<double> simple = simple_knots(row.knots);
  const auto columns = elevation_columns(*lower, simple);
  if (columns[0].size() != row.points.size()) return {};
  const int n = lower->points(), half = n - 1;
  std::vector<double> a(numerics::band_size(n, half));
  Removal result{{*lower, std::vector<Vec4d>(static_cast<std::size_t>(n))}, 0.0};
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = 0.0;
      for (std::size_t r = 0; r < columns[i].size(); ++r) sum += columns[i][r] * columns[j][r];
      a[numerics::band_at(half, i, j)] = sum;
    }
    for (std::size_t r = 0; r < columns[i].size(); ++r)
      result.row.points[i] = result.row.points[i] + columns[i][r] * row.points[r];
  }
  if (numerics::band_factor(n, half, a.data()) >= 0) return {};
  numerics::band_solve(n, half, a.data(), &result.row.points[0].x, 4);
  const Row again = refined(elevated_once(result.row), simple);
  for (std::size_t i = 0; i < row.points.size(); ++i)
    result.misfit = std::max(result.misfit, distance(row.points[i], again.points[i]));
  return result;
}

}  // namespace trocar::geometry::nurbs
