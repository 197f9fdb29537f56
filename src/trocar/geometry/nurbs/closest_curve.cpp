#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <trocar/geometry/nurbs/closest.hpp>
#include <trocar/geometry/nurbs/quadrature.hpp>

namespace trocar::geometry::nurbs {
namespace {

constexpr int kCurveSteps = 60;
constexpr int kCloser = 8;
constexpr double kSafely = 1.01;  // on lengths by quadrature

// How the squared distance changes, half of it: (C - p) C', and how that does.
struct Slope {
  double first, second;
};
Slope slope_at(const Curve& curve, Vec3d p, double u) noexcept {
  const CurveJet at = jet(curve, u);
  const Vec3d away = at.point - p;
  return {dot(away, at.first), dot(at.first, at.first) + dot(away, at.second)};
}

// Where the distance stops falling between a and b: Newton where it stays inside, halves where it does not.
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
  const int count = 4 * curve.knots.degree + 4;
  for (std::size_t s = 0; s + 1 < spans.size(); ++s) {
    const int span = span_of(curve.knots, spans[s]);
    for (int k = 0; k < count; ++k) {
      const double step = (spans[s + 1] - spans[s]) / count, from = spans[s] + k * step;
      const double to = k + 1 == count ? spans[s + 1] : spans[s] + (k + 1) * step;
      const CurveJet a = jet_in_span(curve, span, from), b = jet_in_span(curve, span, to);
      const double way = gauss5(from, to, [&](double u) { return length(jet_in_span(curve, span, u).first); });
      m_pieces.push_back({from, to, a.point, b.point, a.first, b.first, kSafely * way});
    }
  }
}

CurveFoot ClosestOnCurve::find(Vec3d p) const {
  if (!finite(p)) throw std::invalid_argument("closest: the point is not a number");
  CurveFoot best = foot_at(m_curve, p, m_pieces[0].from);
  const auto take = [&best](const CurveFoot& foot) {
    if (foot.distance < best.distance) best = foot;
  };
  for (const Piece& piece : m_pieces)
    if (length(piece.end - p) < best.distance) take(foot_at(m_curve, p, piece.to));
  for (const Piece& piece : m_pieces) {
    const bool falls = dot(piece.start - p, piece.slope_start)<0.0, rises = dot(piece.end - p, piece.slope_end)> 0.0;
    if (!falls || !rises) continue;
    const double nearest = 0.5 * (length(piece.start - p) + length(piece.end - p) - piece.length);
    if (!(nearest < best.distance)) continue;
    // It may do so more than once: look closer.
    double from = piece.from;
    bool falling = true;
    for (int k = 1; k <= kCloser; ++k) {
      const double to = k == kCloser ? piece.to : piece.from + (piece.to - piece.from) * k / kCloser;
      const bool rising = k == kCloser || slope_at(m_curve, p, to).first > 0.0;
      if (falling && rising) take(foot_at(m_curve, p, lowest_between(m_curve, p, from, to)));
      from = to, falling = !rising;
    }
  }
  return best;
}

CurveFoot closest(const Curve& curve, Vec3d p) { return ClosestOnCurve(curve).find(p); }

}  // namespace trocar::geometry::nurbs
