// Exact curves: lines, arcs, circles, ellipses.
//
//   const Curve ring = circle({0, 0, 0.1}, {0, 0, 1}, 0.02);        // closed, 8 control points
//   const Curve bend = arc({0, 0, 0}, {r, 0, 0}, {0, r, 0}, 0.0, 0.5 * portable::pi);
//
// Conics are rational of degree 2.  [PT97 section 7.5]
#pragma once

#include <span>

#include <trocar/geometry/nurbs/curve.hpp>

namespace trocar::geometry::nurbs {

/// From a to b at even speed, parameter 0 .. 1.
Curve line(Vec3d a, Vec3d b);
/// Straight from point to point (at least 2), degree 1, by the length of the chords, parameter 0 .. 1.
/// @throws std::invalid_argument where neighbours coincide or are not numbers
Curve polyline(std::span<const Vec3d> points);

/// Points centre + x cos a + y sin a for the angles a from `start` to `end` [rad], start < end <= start + 2 pi: of an
/// ellipse with the half-axes x and y, of a circle where they are equally long and at right angles. Clamped, parameter
/// 0 .. 1.  [PT97 A7.1]
Curve arc(Vec3d centre, Vec3d x, Vec3d y, double start, double end);
/// All of it: periodic, parameter 0 .. 1 once around from centre + x over centre + y; 8 control points.
Curve ellipse(Vec3d centre, Vec3d x, Vec3d y);
/// Around the axis `normal` (any length), counter-clockwise seen from where it points.
Curve circle(Vec3d centre, Vec3d normal, double radius);

/// Control points of the unit circle that `ellipse` turns into others, with their weights.
struct RingPoint {
  double x, y, weight;
};
std::span<const RingPoint> unit_ring();  ///< 8
Knots ring_knots();                      ///< periodic, degree 2, double knots at the quarters

}  // namespace trocar::geometry::nurbs
