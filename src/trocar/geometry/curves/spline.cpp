#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <trocar/geometry/curves/spline.hpp>

namespace trocar::geometry {
namespace {

double quotient(double a, double b) noexcept { return b > 0.0 ? a / b : 0.0; }

// Derivatives of the degree q functions from the values (or derivatives) of those of degree q - 1: both hold the
// functions that do not vanish in knot span s.
void differentiate(std::span<const double> knots, int q, int s, const double* lower, double* result) noexcept {
  for (int k = 0; k <= q; ++k) {
    const int i = s - q + k;
    const double rising = k > 0 ? quotient(lower[k - 1], knots[i + q] - knots[i]) : 0.0;
    const double falling = k < q ? quotient(lower[k], knots[i + q + 1] - knots[i + 1]) : 0.0;
    result[k] = q * (rising - falling);
  }
}

double into_domain(double u, double start, double end, bool periodic) noexcept {
  if (periodic) return u - std::floor((u - start) / (end - start)) * (end - start);
  return std::clamp(u, start, end);
}

// Tridiagonal systems by elimination without pivoting (the matrices here are dominated by their diagonal). Row i is
// below[i] x[i-1] + centre[i] x[i] + above[i] x[i+1].
struct Tridiagonal {
  std::vector<double> below, centre, above;
  explicit Tridiagonal(std::size_t n) : below(n), centre(n), above(n) {}

  template <class V>
  void solve(std::vector<V>& x) const {
    const std::size_t n = centre.size();
    std::vector<double> pivot = centre;
    for (std::size_t i = 1; i < n; ++i) {
      const double factor = below[i] / pivot[i - 1];
      pivot[i] -= factor * above[i - 1];
      x[i] -= factor * x[i - 1];
    }
    x[n - 1] = x[n - 1] / pivot[n - 1];
    for (std::size_t i = n - 1; i-- > 0;) x[i] = (x[i] - above[i] * x[i + 1]) / pivot[i];
  }

  // With x[-1] meaning x[n-1] and x[n] meaning x[0]: the two corners as a rank one change. [Sherman & Morrison 1950]
  void solve_cyclic(std::vector<Vec3d>& x) const {
    const std::size_t n = centre.size();
    const double gamma = -centre[0], corner = below[0] / gamma;
    Tridiagonal plain = *this;
    plain.centre[0] -= gamma;
    plain.centre[n - 1] -= corner * above[n - 1];
    std::vector<double> z(n, 0.0);
    z[0] = gamma;
    z[n - 1] = above[n - 1];
    plain.solve(x);
    plain.solve(z);
    const Vec3d share = (x[0] + corner * x[n - 1]) / (1.0 + z[0] + corner * z[n - 1]);
    for (std::size_t i = 0; i < n; ++i) x[i] -= z[i] * share;
  }
};

void require_ascending(std::span<const double> parameters, std::size_t points, const char* what) {
  if (parameters.size() != points)
    throw std::invalid_argument(std::string(what) + ": one parameter per point expected");
  for (std::size_t i = 1; i < parameters.size(); ++i)
    if (!(parameters[i] > parameters[i - 1]))
      throw std::invalid_argument(std::string(what) + ": points " + std::to_string(i - 1) + " and " +
                                  std::to_string(i) + " coincide");
}

}  // namespace

Basis basis_functions(std::span<const double> knots, int degree, double u) noexcept {
  const int last = static_cast<int>(knots.size()) - 2 - degree;  // of the functions; also the last span of the domain
  u = std::clamp(u, knots[degree], knots[last + 1]);
  const auto above = std::upper_bound(knots.begin() + degree, knots.begin() + last + 1, u);
  int s = static_cast<int>(above - knots.begin()) - 1;
  while (s > degree && knots[s + 1] == knots[s]) --s;  // at the end of the domain: the last span that has a length

  // values[q][k]: function s - q + k of degree q.  [Piegl & Tiller, eq. 2.5 (Cox & de Boor)]
  double values[kMaxDegree + 1][kMaxDegree + 1] = {};
  values[0][0] = 1.0;
  for (int q = 1; q <= degree; ++q)
    for (int k = 0; k <= q; ++k) {
      const int i = s - q + k;
      const double rising = k > 0 ? values[q - 1][k - 1] * quotient(u - knots[i], knots[i + q] - knots[i]) : 0.0;
      const double falling =
          k < q ? values[q - 1][k] * quotient(knots[i + q + 1] - u, knots[i + q + 1] - knots[i + 1]) : 0.0;
      values[q][k] = rising + falling;
    }

  Basis basis;
  basis.first = s - degree;
  for (int k = 0; k <= degree; ++k) basis.value[0][k] = values[degree][k];
  if (degree >= 1) differentiate(knots, degree, s, values[degree - 1], basis.value[1]);
  if (degree >= 2) {
    double slopes[kMaxDegree + 1] = {};
    differentiate(knots, degree - 1, s, values[degree - 2], slopes);
    differentiate(knots, degree, s, slopes, basis.value[2]);
  }
  return basis;
}

CurvePoint NurbsCurve::at(double u) const noexcept {
  const Basis basis = basis_functions(knots, degree, into_domain(u, start(), end(), periodic));
  Vec3d a[3];
  double w[3] = {};
  for (int d = 0; d < 3; ++d)
    for (int k = 0; k <= degree; ++k) {
      const int i = basis.first + k;
      const double share = basis.value[d][k] * (weights.empty() ? 1.0 : weights[i]);
      a[d] += share * control[i];
      w[d] += share;
    }
  if (weights.empty()) return {a[0], a[1], a[2]};
  // Derivatives of the quotient.  [Piegl & Tiller, eq. 4.8]
  CurvePoint result;
  result.point = a[0] / w[0];
  result.first = (a[1] - w[1] * result.point) / w[0];
  result.second = (a[2] - 2.0 * w[1] * result.first - w[2] * result.point) / w[0];
  return result;
}

NurbsCurve clamped_cubic(std::span<const Vec3d> control) {
  if (control.size() < 4) throw std::invalid_argument("clamped_cubic: at least 4 control points expected");
  NurbsCurve curve;
  curve.control.assign(control.begin(), control.end());
  const int spans = static_cast<int>(control.size()) - 3;
  for (int i = -3; i <= spans + 3; ++i) curve.knots.push_back(std::clamp(i, 0, spans) / double(spans));
  return curve;
}

NurbsCurve periodic_cubic(std::span<const Vec3d> control) {
  if (control.size() < 3) throw std::invalid_argument("periodic_cubic: at least 3 control points expected");
  NurbsCurve curve;
  curve.periodic = true;
  const int n = static_cast<int>(control.size());
  for (int i = 0; i < n + 3; ++i) curve.control.push_back(control[i % n]);
  for (int i = -3; i <= n + 3; ++i) curve.knots.push_back(i / double(n));
  return curve;
}

std::vector<double> chord_parameters(std::span<const Vec3d> points, bool closed) {
  std::vector<double> parameters(points.size(), 0.0);
  for (std::size_t i = 1; i < points.size(); ++i) parameters[i] = parameters[i - 1] + length(points[i] - points[i - 1]);
  if (points.empty()) return parameters;
  const double total = parameters.back() + (closed ? length(points.front() - points.back()) : 0.0);
  if (total > 0.0)
    for (double& parameter : parameters) parameter /= total;
  return parameters;
}

NurbsCurve interpolated(std::span<const Vec3d> points, std::span<const double> parameters, const EndSlopes& slopes) {
  if (points.size() < 2) throw std::invalid_argument("interpolated: at least 2 points expected");
  require_ascending(parameters, points.size(), "interpolated");
  const std::size_t n = points.size() - 1;
  NurbsCurve curve;
  curve.knots.assign(3, parameters.front());
  curve.knots.insert(curve.knots.end(), parameters.begin(), parameters.end());
  curve.knots.insert(curve.knots.end(), 3, parameters.back());

  // Unknown are the control points 1 .. n+1 (0 and n+2 are the end points): x[i] is control point i + 1.
  Tridiagonal rows(n + 1);
  std::vector<Vec3d> x(n + 1);
  const Basis at_start = basis_functions(curve.knots, 3, parameters.front());
  const Basis at_end = basis_functions(curve.knots, 3, parameters.back());
  if (slopes.start) {
    rows.centre[0] = at_start.value[1][1];
    x[0] = *slopes.start - at_start.value[1][0] * points.front();
  } else {
    rows.centre[0] = at_start.value[2][1];
    rows.above[0] = at_start.value[2][2];
    x[0] = -at_start.value[2][0] * points.front();
  }
  for (std::size_t i = 1; i < n; ++i) {
    const Basis b = basis_functions(curve.knots, 3, parameters[i]);  // the fourth function is 0 on a knot
    rows.below[i] = b.value[0][0];
    rows.centre[i] = b.value[0][1];
    rows.above[i] = b.value[0][2];
    x[i] = points[i];
  }
  if (slopes.end) {
    rows.centre[n] = at_end.value[1][2];
    x[n] = *slopes.end - at_end.value[1][3] * points.back();
  } else {
    rows.below[n] = at_end.value[2][1];
    rows.centre[n] = at_end.value[2][2];
    x[n] = -at_end.value[2][3] * points.back();
  }
  rows.solve(x);
  curve.control.push_back(points.front());
  curve.control.insert(curve.control.end(), x.begin(), x.end());
  curve.control.push_back(points.back());
  return curve;
}

NurbsCurve interpolated(std::span<const Vec3d> points) { return interpolated(points, chord_parameters(points)); }

NurbsCurve interpolated_closed(std::span<const Vec3d> points, std::span<const double> parameters, double period) {
  if (points.size() < 3) throw std::invalid_argument("interpolated_closed: at least 3 points expected");
  require_ascending(parameters, points.size(), "interpolated_closed");
  const int n = static_cast<int>(points.size());
  if (!(parameters[n - 1] < parameters[0] + period))
    throw std::invalid_argument("interpolated_closed: the first and the last point coincide");
  NurbsCurve curve;
  curve.periodic = true;
  for (int i = -3; i <= n + 3; ++i) {
    const int turns = i < 0 ? -1 : i / n;  // n >= 3
    curve.knots.push_back(parameters[i - turns * n] + turns * period);
  }
  // Row k: the curve at parameter k, on whose knot the functions k, k+1, k+2 live; x[k] is control point k + 1.
  Tridiagonal rows(n);
  std::vector<Vec3d> x(points.begin(), points.end());
  for (int k = 0; k < n; ++k) {
    const Basis b = basis_functions(curve.knots, 3, curve.knots[k + 3]);
    rows.below[k] = b.value[0][0];
    rows.centre[k] = b.value[0][1];
    rows.above[k] = b.value[0][2];
  }
  rows.solve_cyclic(x);
  for (int i = 0; i < n + 3; ++i) curve.control.push_back(x[(i + n - 1) % n]);
  return curve;
}

NurbsCurve interpolated_closed(std::span<const Vec3d> points) {
  return interpolated_closed(points, chord_parameters(points, true), 1.0);
}

SurfacePoint NurbsSurface::at(double u, double v) const noexcept {
  const Basis bu = basis_functions(knots_u, degree_u, into_domain(u, start_u(), end_u(), periodic_u));
  const Basis bv = basis_functions(knots_v, degree_v, into_domain(v, start_v(), end_v(), periodic_v));
  SurfacePoint sum{};
  double w = 0.0, wu = 0.0, wv = 0.0;
  for (int l = 0; l <= degree_v; ++l)
    for (int k = 0; k <= degree_u; ++k) {
      const std::size_t index = bu.first + k + std::size_t(count_u) * (bv.first + l);
      const double weight = weights.empty() ? 1.0 : weights[index];
      const double n = weight * bu.value[0][k] * bv.value[0][l];
      const double nu = weight * bu.value[1][k] * bv.value[0][l];
      const double nv = weight * bu.value[0][k] * bv.value[1][l];
      sum.point += n * control[index];
      sum.du += nu * control[index];
      sum.dv += nv * control[index];
      w += n, wu += nu, wv += nv;
    }
  if (weights.empty()) return sum;
  sum.point = sum.point / w;
  sum.du = (sum.du - wu * sum.point) / w;
  sum.dv = (sum.dv - wv * sum.point) / w;
  return sum;
}

}  // namespace trocar::geometry
