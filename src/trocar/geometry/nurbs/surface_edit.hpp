// Surfaces described otherwise: curve_edit.hpp in either direction, iso-curves, parts, turned and mirrored.
//
//   Surface finer = inserted(surface, Along::u, 0.3);
//   const Curve ring = iso_curve(surface, Along::u, 0.5);           // the curve along u at v = 0.5
//   const Surface left = mirrored(right, {0, 0, 0}, {1, 0, 0});     // normals stay outwards
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include <trocar/geometry/nurbs/curve.hpp>
#include <trocar/geometry/nurbs/surface.hpp>

namespace trocar::geometry::nurbs {

enum class Along { u, v };
inline const Knots& knots_along(const Surface& surface, Along way) { return way == Along::u ? surface.u : surface.v; }

Surface inserted(const Surface& surface, Along way, double t, int times = 1);         ///< [PT97 A5.3]
Surface refined(const Surface& surface, Along way, const std::vector<double>& more);  ///< [PT97 A5.5]
Surface elevated(const Surface& surface, Along way, int times = 1);                   ///< [PT97 A5.10]
Surface reversed(const Surface& surface, Along way);                                  ///< normals turn round, too
Surface opened(const Surface& surface, Along way, double t);                          ///< periodic to clamped
Surface part(const Surface& surface, Along way, double a, double b);
std::pair<Surface, Surface> split(const Surface& surface, Along way, double t);
/// a, and on from its end along `way` b, which starts there: the same curve across, over the same knots (1e-9 m).
Surface joined(const Surface& a, const Surface& b, Along way);
Surface on_domain(const Surface& surface, Along way, double start, double end);
Surface transposed(const Surface& surface);                             ///< u for v; normals turn round
Surface moved(const Surface& surface, const Mat3d& turn, Vec3d shift);  ///< x -> turn x + shift
/// The mirror image in the plane through `at` with this normal, u run through the other way so that du x dv of a body
/// still points out of it.
Surface mirrored(const Surface& surface, Vec3d at, Vec3d plane_normal);

/// As without_knot of curves, for all rows at once: tolerance [m] on every point of the surface.
std::optional<Surface> without_knot(const Surface& surface, Along way, double t, double tolerance);
std::optional<Surface> reduced(const Surface& surface, Along way, double tolerance);

/// The curve in the surface along u (at this v) or along v (at this u).
Curve iso_curve(const Surface& surface, Along way, double at);

/// All rows of control points along u or v, weighted; and a surface of such rows and the other direction's knots.
std::vector<Row> rows_of(const Surface& surface, Along way);
Surface surface_of(const std::vector<Row>& rows, Along way, const Knots& other);

}  // namespace trocar::geometry::nurbs
