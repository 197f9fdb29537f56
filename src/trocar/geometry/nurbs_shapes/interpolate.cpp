#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/nurbs/basis.hpp>
#include <trocar/geometry/nurbs_shapes/interpolate.hpp>

namespace trocar::geometry::nurbs {
namespace {

// One equation: the functions (or their slopes) at a parameter.
void set_row(const Knots& knots, double u, int derivative, double* row) {
  const Basis2 basis = basis_at(knots, u, derivative);
  for (int k = 0; k <= knots.degree; ++k) row[knots.point_of(basis.first + k)] += basis.value[derivative][k];
}

numerics::DenseLu factored(const Knots& knots, std::span<const double> parameters, bool start_slope, bool end_slope) {
  const int n = knots.points(), values = static_cast<int>(parameters.size());
  std::vector<double> a(static_cast<std::size_t>(n) * n);
  int row = 0;
  const auto next = [&](double u, int derivative) {
    set_row(knots, u, derivative, &a[static_cast<std::size_t>(n) * row++]);
  };
  for (int i = 0; i < values; ++i) {
    if (end_slope && i == values - 1) next(parameters[i], 1);
    next(parameters[i], 0);
    if (start_slope && i == 0) next(parameters[i], 1);
  }
  numerics::DenseLu lu(n, std::move(a));
  if (lu.singular()) throw std::invalid_argument("Interpolation: the parameters lie too close to each other");
  return lu;
}

// Each knot is the mean of `degree` neighbouring parameters, an end with a slope counting twice.
// [PT97 eq.9.8] [PT97 eq.9.20]
Knots averaged_knots(std::span<const double> parameters, int degree, bool start_slope, bool end_slope) {
  if (parameters.size() < 2) throw std::invalid_argument("Interpolation: at least 2 parameters expected");
  std::vector<double> all(parameters.begin(), parameters.end());
  if (start_slope) all.insert(all.begin(), all.front());
  if (end_slope) all.push_back(all.back());
  const int n = static_cast<int>(all.size()), p = std::clamp(degree, 1, std::min(kHighestDegree, n - 1));
  std::vector<double> inside;
  for (int j = 1; j + p < n; ++j) {
    double sum = 0.0;
    for (int k = 0; k < p; ++k) sum += all[j + k];
    inside.push_back(sum / p);
  }
  return clamped(p, all.front(), inside, all.back());
}

// The same around. Knots at the parameters do for odd degrees, and the first point is where the domain starts; for even
// ones they are means again, and the domain starts somewhere between.
Knots averaged_round(std::span<const double> parameters, double period, int degree) {
  const int n = static_cast<int>(parameters.size());
  if (n < degree + 1)
    throw std::invalid_argument(tr("Interpolation: more than {} points expected around, got {}", degree, n));
  const int mean_of = degree % 2 == 1 ? 1 : degree;
  std::vector<double> round;
  for (int j = 0; j < n; ++j) {
    double sum = 0.0;
    for (int k = 0; k < mean_of; ++k) sum += parameters[(j + k) % n] + (j + k >= n ? period : 0.0);
    round.push_back(sum / mean_of);
  }
  return periodic(degree, round, period);
}

std::vector<double> flat(const std::vector<Vec3d>& points) {
  std::vector<double> result;
  for (const Vec3d& p : points) result.insert(result.end(), {p.x, p.y, p.z});
  return result;
}

std::vector<Vec3d> unflat(const std::vector<double>& numbers) {
  std::vector<Vec3d> result;
  for (std::size_t i = 0; i < numbers.size(); i += 3) result.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  return result;
}

}  // namespace

std::vector<double> parameters_by(Spacing spacing, std::span<const Vec3d> points, const char* who, bool closed) {
  const std::size_t n = points.size();
  if (n < 2) throw std::invalid_argument(tr("{}: at least 2 points expected, got {}", who, n));
  for (std::size_t i = 0; i < n; ++i)
    if (!finite(points[i])) throw std::invalid_argument(tr("{}: point {} is not a number", who, i));
  std::vector<double> way{0.0};
  for (std::size_t i = 1; i < n + (closed ? 1 : 0); ++i) {
    const double chord = length(points[i % n] - points[i - 1]);
    if (!(chord > 0.0)) throw std::invalid_argument(tr("{}: points {} and {} coincide", who, i - 1, i % n));
    way.push_back(way.back() + (spacing == Spacing::chord ? chord : std::sqrt(chord)));
  }
  const double whole = way.back();
  way.resize(n);
  for (double& w : way) w /= whole;
  if (!closed) way.back() = 1.0;
  for (std::size_t i = 1; i < n; ++i)
    if (!(way[i] > way[i - 1]))
      throw std::invalid_argument(tr("{}: points {} and {} coincide but for rounding", who, i - 1, i));
  return way;
}

Interpolation::Interpolation(std::span<const double> parameters, int degree, bool start_slope, bool end_slope)
    : m_knots(averaged_knots(parameters, degree, start_slope, end_slope)),
      m_system(factored(m_knots, parameters, start_slope, end_slope)) {}

Interpolation Interpolation::closed(std::span<const double> parameters, double period, int degree) {
  const Knots knots = averaged_round(parameters, period, degree);
  return {knots, factored(knots, parameters, false, false)};
}

Curve curve_through(std::span<const Vec3d> points, int degree, Spacing spacing, const Slopes& slopes) {
  const std::vector<double> parameters = parameters_by(spacing, points, "curve_through");
  std::vector<Vec3d> values(points.begin(), points.end());
  if (slopes.start) values.insert(values.begin() + 1, *slopes.start);
  if (slopes.end) values.insert(values.end() - 1, *slopes.end);
  const Interpolation system(parameters, degree, slopes.start.has_value(), slopes.end.has_value());
  std::vector<double> numbers = flat(values);
  system.solve(numbers.data(), 3);
  Curve curve{system.knots(), unflat(numbers), {}};
  curve.points.front() = points.front(), curve.points.back() = points.back();
  return curve;
}

Curve closed_curve_through(std::span<const Vec3d> points, int degree, Spacing spacing) {
  const std::vector<double> parameters = parameters_by(spacing, points, "closed_curve_through", true);
  const Interpolation system = Interpolation::closed(parameters, 1.0, degree);
  std::vector<double> numbers = flat({points.begin(), points.end()});
  system.solve(numbers.data(), 3);
  return {system.knots(), unflat(numbers), {}};
}

}  // namespace trocar::geometry::nurbs
