#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <trocar/geometry/nurbs/closest.hpp>

namespace trocar::geometry::nurbs {
namespace {

constexpr int kCurveSteps = 60;

// How the squared distance changes, half of it: (C - p) C', and how that does.
struct Slope {
  double first, second;
};
Slope slope_at(const Curve& curve, Vec3d p, double u) noexcept {
  const CurveJet at = jet(curve, u);
  const Vec3d away = at.point - p;
  return {dot(away, at.first), dot(at.first, at.first) + dot(away, at.second)};
}

// Where the distance stops falling between a and b: Newton where it stays inside, halves where it does not. Corners of
// the curve, where the slope jumps over 0, are found as well.
double lowest_between(const Curve& curve, Vec3d p, double a, double b) noexcept {
  double u = 0.5 * (a + b);
  const double slack = 1e-15 * curve.knots.extent();
  for (int step = 0; step < kCurveSteps && b - a > slack; ++step) {
    const Slope slope = slope_at(curve, p, u);
    if (slope.first == 0.0) return u;
    (slope.first > 0.0 ? b : a) = u;
    const double next = u - slope.first / slope.second;
    const bool inside = slope.second > 0.0 && next > a && next < b;
    if (inside && std::fabs(next - u) <= slack) return next;
    u = inside ? next : 0.5 * (a + b);
  }
  return u;
}

CurveFoot foot_at(const Curve& curve, Vec3d p, double u) noexcept {
  const Vec3d c = point(curve, u);
  return {into_domain(curve.knots, u), c, length(c - p)};
}

}  // namespace

ClosestOnCurve::ClosestOnCurve(const Curve& curve) : m_curve(curve) {
  require_valid(curve, "closest");
  const std::vector<double> spans = breaks(curve.knots);
  const int samples = 2 * curve.knots.degree + 2;
  for (std::size_t s = 0; s + 1 < spans.size(); ++s)
    for (int k = 0; k < samples; ++k) m_u.push_back(spans[s] + (spans[s + 1] - spans[s]) * k / samples);
  m_u.push_back(spans.back());
  for (double u : m_u) m_points.push_back(point(curve, u));
}

CurveFoot ClosestOnCurve::find(Vec3d p) const {
  if (!finite(p)) throw std::invalid_argument("closest: the point is not a number");
  const std::size_t n = m_u.size();
  std::vector<double> distance(n);
  for (std::size_t i = 0; i < n; ++i) distance[i] = length(m_points[i] - p);
  CurveFoot best = foot_at(m_curve, p, m_u[0]);
  const auto take = [&best](const CurveFoot& foot) {
    if (foot.distance < best.distance) best = foot;
  };
  take(foot_at(m_curve, p, m_u[n - 1]));
  for (std::size_t i = 0; i < n; ++i) {
    if ((i > 0 && distance[i - 1] < distance[i]) || (i + 1 < n && distance[i + 1] < distance[i])) continue;
    // Either side alone, as a corner may lie between; then the sample itself.
    if (i > 0) take(foot_at(m_curve, p, lowest_between(m_curve, p, m_u[i - 1], m_u[i])));
    if (i + 1 < n) take(foot_at(m_curve, p, lowest_between(m_curve, p, m_u[i], m_u[i + 1])));
    take(foot_at(m_curve, p, m_u[i]));
  }
  return best;
}

CurveFoot closest(const Curve& curve, Vec3d p) { return ClosestOnCurve(curve).find(p); }

}  // namespace trocar::geometry::nurbs
