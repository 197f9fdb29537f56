#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/nurbs_shapes/curve_makers.hpp>
#include <trocar/geometry/nurbs_shapes/interpolate.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::geometry::nurbs {
namespace {

// sqrt(1/2) as a double; the corners of a square around a circle have this weight.
constexpr double kCornerWeight = 0.70710678118654752440;

}  // namespace

std::span<const RingPoint> unit_ring() {
  static const RingPoint ring[8] = {{1, -1, kCornerWeight}, {1, 0, 1},  {1, 1, kCornerWeight},   {0, 1, 1},
                                    {-1, 1, kCornerWeight}, {-1, 0, 1}, {-1, -1, kCornerWeight}, {0, -1, 1}};
  return ring;
}

Knots ring_knots() { return periodic(2, {0.0, 0.0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75}, 1.0); }

Curve line(Vec3d a, Vec3d b) {
  Curve curve{clamped_uniform(1, 2), {a, b}, {}};
  require_valid(curve, "line");
  return curve;
}

Curve polyline(std::span<const Vec3d> points) {
  const std::vector<double> t = parameters_by(Spacing::chord, points, "polyline");
  Curve curve{clamped(1, 0.0, {t.begin() + 1, t.end() - 1}, 1.0), {points.begin(), points.end()}, {}};
  require_valid(curve, "polyline");
  return curve;
}

Curve arc(Vec3d centre, Vec3d x, Vec3d y, double start, double end) {
  const double whole = end - start;
  if (!(whole > 0.0) || !(whole <= portable::two_pi * (1.0 + 1e-12)))
    throw std::invalid_argument(tr("arc: an angle above 0 and up to 2 pi expected, got {}", whole));
  const int arcs = std::max(1, static_cast<int>(std::ceil(whole / (0.5 * portable::pi) - 1e-9)));
  const double half = 0.5 * whole / arcs, corner = portable::cos(half);
  const auto on_circle = [&](double angle, double radius) {
    return centre + (radius * portable::cos(angle)) * x + (radius * portable::sin(angle)) * y;
  };
  Curve curve;
  std::vector<double> inside;
  curve.points.push_back(on_circle(start, 1.0));
  curve.weights.push_back(1.0);
  for (int k = 0; k < arcs; ++k) {
    const double from = start + 2.0 * half * k;
    curve.points.push_back(on_circle(from + half, 1.0 / corner));
    curve.weights.push_back(corner);
    curve.points.push_back(on_circle(k + 1 == arcs ? end : from + 2.0 * half, 1.0));
    curve.weights.push_back(1.0);
    if (k > 0) inside.insert(inside.end(), 2, k / double(arcs));
  }
  curve.knots = clamped(2, 0.0, inside, 1.0);
  require_valid(curve, "arc");
  return curve;
}

Curve ellipse(Vec3d centre, Vec3d x, Vec3d y) {
  Curve curve{ring_knots(), {}, {}};
  for (const RingPoint& p : unit_ring()) {
    curve.points.push_back(centre + p.x * x + p.y * y);
    curve.weights.push_back(p.weight);
  }
  require_valid(curve, "ellipse");
  return curve;
}

Curve circle(Vec3d centre, Vec3d normal, double radius) {
  const Vec3d n = normalised(normal, Vec3d{});
  if (!(radius > 0.0) || n == Vec3d{}) throw std::invalid_argument("circle: a radius above 0 and a normal expected");
  const Vec3d x = any_perpendicular(n);
  return ellipse(centre, radius * x, radius * cross(n, x));
}

}  // namespace trocar::geometry::nurbs
