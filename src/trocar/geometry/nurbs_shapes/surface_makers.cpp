#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/nurbs/surface_edit.hpp>
#include <trocar/geometry/nurbs_shapes/curve_makers.hpp>
#include <trocar/geometry/nurbs_shapes/skin.hpp>
#include <trocar/geometry/nurbs_shapes/surface_makers.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::geometry::nurbs {
namespace {

Vec3d unit(Vec3d axis, const char* who) {
  const Vec3d n = normalised(axis, Vec3d{});
  if (!finite(axis) || n == Vec3d{}) throw std::invalid_argument(tr("{}: an axis expected", who));
  return n;
}

void require_radius(double radius, const char* who) {
  if (!(radius > 0.0) || !std::isfinite(radius))
    throw std::invalid_argument(tr("{}: a radius above 0 expected, got {}", who, radius));
}

// From one pole of the unit sphere's meridian to the other, exactly.
struct MeridianPoint {
  double out, up, weight;
};
constexpr double kHalfRoot = 0.70710678118654752440;
constexpr MeridianPoint kMeridian[5] = {{0, -1, 1}, {1, -1, kHalfRoot}, {1, 0, 1}, {1, 1, kHalfRoot}, {0, 1, 1}};

// Each control point goes along a unit circle's (or arc's) ones, about its foot on the axis.
Surface turned(const Curve& curve, Vec3d at, Vec3d n, const Knots& around, std::span<const RingPoint> ring) {
  Surface surface{around, curve.knots, {}, {}};
  for (std::size_t j = 0; j < curve.points.size(); ++j) {
    const Vec3d foot = at + dot(curve.points[j] - at, n) * n, x = curve.points[j] - foot, y = cross(n, x);
    for (const RingPoint& p : ring) {
      surface.points.push_back(foot + p.x * x + p.y * y);
      surface.weights.push_back(p.weight * curve.weight(static_cast<int>(j)));
    }
  }
  return surface;
}

}  // namespace

Surface plane(Vec3d corner, Vec3d edge_u, Vec3d edge_v) {
  Surface s{clamped_uniform(1, 2), clamped_uniform(1, 2), {}, {}};
  s.points = {corner, corner + edge_u, corner + edge_v, corner + edge_u + edge_v};
  require_valid(s, "plane");
  return s;
}

Surface ruled(const Curve& a, const Curve& b) {
  const std::vector<Curve> pair = compatible({a, b});
  Surface s{pair[0].knots, clamped_uniform(1, 2), pair[0].points, {}};
  s.points.insert(s.points.end(), pair[1].points.begin(), pair[1].points.end());
  if (pair[0].weights.empty() && pair[1].weights.empty()) return s;
  for (const Curve& curve : pair)
    for (std::size_t i = 0; i < curve.points.size(); ++i) s.weights.push_back(curve.weight(static_cast<int>(i)));
  return s;
}

Surface revolved(const Curve& curve, Vec3d at, Vec3d axis) {
  require_valid(curve, "revolved");
  return turned(curve, at, unit(axis, "revolved"), ring_knots(), unit_ring());
}

Surface revolved(const Curve& curve, Vec3d at, Vec3d axis, double angle) {
  require_valid(curve, "revolved");
  const Curve swept = arc({}, {1, 0, 0}, {0, 1, 0}, 0.0, angle);
  std::vector<RingPoint> ring;
  for (std::size_t i = 0; i < swept.points.size(); ++i)
    ring.push_back({swept.points[i].x, swept.points[i].y, swept.weights[i]});
  return turned(curve, at, unit(axis, "revolved"), swept.knots, ring);
}

Surface cylinder(Vec3d base, Vec3d axis, double radius) { return cone(base, axis, radius, radius); }

Surface cone(Vec3d base, Vec3d axis, double base_radius, double top_radius) {
  const Vec3d n = unit(axis, "cone"), x = any_perpendicular(n);
  require_radius(std::max(base_radius, top_radius), "cone");
  if (!(base_radius >= 0.0) || !(top_radius >= 0.0)) throw std::invalid_argument("cone: radii of at least 0 expected");
  return revolved(line(base + base_radius * x, base + axis + top_radius * x), base, n);
}

Surface sphere(Vec3d centre, double radius, Vec3d axis) {
  const Vec3d n = unit(axis, "sphere"), x = any_perpendicular(n);
  require_radius(radius, "sphere");
  return ellipsoid(centre, radius * x, radius * cross(n, x), radius * n);
}

Surface ellipsoid(Vec3d centre, Vec3d a, Vec3d b, Vec3d c) {
  Surface s{ring_knots(), clamped(2, 0.0, {0.5, 0.5}, 1.0), {}, {}};
  for (const MeridianPoint& m : kMeridian)
    for (const RingPoint& r : unit_ring()) {
      s.points.push_back(centre + (m.out * r.x) * a + (m.out * r.y) * b + m.up * c);
      s.weights.push_back(m.weight * r.weight);
    }
  require_valid(s, "ellipsoid");
  if (!(std::fabs(dot(a, cross(b, c))) > 0.0)) throw std::invalid_argument("ellipsoid: three half-axes expected");
  return s;
}

Surface torus(Vec3d centre, Vec3d axis, double radius, double tube_radius) {
  const Vec3d n = unit(axis, "torus"), x = any_perpendicular(n);
  require_radius(tube_radius, "torus");
  require_radius(radius, "torus");
  return revolved(ellipse(centre + radius * x, tube_radius * x, tube_radius * n), centre, n);
}

}  // namespace trocar::geometry::nurbs
