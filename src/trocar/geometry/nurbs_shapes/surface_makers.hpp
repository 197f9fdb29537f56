// Exact surfaces: planes, surfaces of revolution, ruled ones.
//
//   const Surface ball = sphere({0, 0, 0}, 0.03);
//   const Surface wall = cylinder({0, 0, 0}, {0, 0, 0.1}, 0.01);    // open at both ends; capped() closes it
//
// u runs around the axis, counter-clockwise seen from where it points, v along it; du x dv points outwards.
// [PT97 chapter 8]
#pragma once

#include <trocar/geometry/nurbs/curve.hpp>
#include <trocar/geometry/nurbs/surface.hpp>

namespace trocar::geometry::nurbs {

/// corner + u edge_u + v edge_v, u and v 0 .. 1.
Surface plane(Vec3d corner, Vec3d edge_u, Vec3d edge_v);
/// Straight from a point of `a` (v = 0) to the same point of `b` (v = 1), after both have been made alike.
Surface ruled(const Curve& a, const Curve& b);

/// The curve turned about the axis through `at`, once around (u is periodic, 8 control points) or by an angle [rad] up
/// to 2 pi (clamped). Points of the curve on the axis become poles.  [PT97 A8.1]
Surface revolved(const Curve& curve, Vec3d at, Vec3d axis);
Surface revolved(const Curve& curve, Vec3d at, Vec3d axis, double angle);

/// `axis` is the vector from the base's centre to the top's.
Surface cylinder(Vec3d base, Vec3d axis, double radius);
/// From the radius at the base to that at the top; one of them may be 0, which makes a pole.
Surface cone(Vec3d base, Vec3d axis, double base_radius, double top_radius);
/// Poles at centre -+ radius axis.
Surface sphere(Vec3d centre, double radius, Vec3d axis = {0, 0, 1});
/// The unit sphere's image: poles at centre -+ c, half-axes a, b, c (right-handed for normals outwards).
Surface ellipsoid(Vec3d centre, Vec3d a, Vec3d b, Vec3d c);
/// u around the axis at `radius`, v around the tube of `tube_radius`; both periodic.
Surface torus(Vec3d centre, Vec3d axis, double radius, double tube_radius);

}  // namespace trocar::geometry::nurbs
