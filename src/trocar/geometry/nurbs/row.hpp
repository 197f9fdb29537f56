// Rows of weighted control points (w x, w y, w z, w) over a knot vector: what changes a spline's description without
// changing its shape, once for curves and, row by row, for both directions of surfaces.
//
//   Row row = inserted({knots, points}, 0.4, 1);
//   row = elevated(row, 1);
//
// All of it holds for clamped and for periodic knots. Parameters that differ from a knot by rounding only are taken for
// that knot.
#pragma once

#include <optional>
#include <vector>

#include <trocar/geometry/nurbs/knots.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry::nurbs {

/// A weighted point: the place is (x, y, z) / w.  [PT97 section 1.4]
struct Vec4d {
  double x = 0, y = 0, z = 0, w = 0;

  Vec3d place() const noexcept { return Vec3d{x, y, z} / w; }
  friend Vec4d operator+(Vec4d a, Vec4d b) noexcept { return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w}; }
  friend Vec4d operator-(Vec4d a, Vec4d b) noexcept { return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w}; }
  friend Vec4d operator*(double s, Vec4d a) noexcept { return {s * a.x, s * a.y, s * a.z, s * a.w}; }
  friend bool operator==(Vec4d, Vec4d) = default;
};
inline Vec4d weighted(Vec3d p, double w) noexcept { return {w * p.x, w * p.y, w * p.z, w}; }
/// (1 - t) a + t b
inline Vec4d blend(Vec4d a, Vec4d b, double t) noexcept { return (1.0 - t) * a + t * b; }
double distance(Vec4d a, Vec4d b) noexcept;

struct Row {
  Knots knots;
  std::vector<Vec4d> points;  ///< knots.points() of them
};

/// The knot of the domain that u is, rounding apart (1e-12 of the domain's extent); else u.
double snapped(const Knots& knots, double u) noexcept;

/// The same row with u as a knot `times` times more, at most until it is there `degree` times. u is brought into the
/// domain; the ends of a clamped row stay as they are.  [PT97 A5.1]
Row inserted(const Row& row, double u, int times);
/// The same row with all of these as knots once more each (repeated as wished).  [PT97 A5.4]
Row refined(const Row& row, const std::vector<double>& more);

/// The row with u as a knot once less, and how far the weighted points are from ones for which that would change
/// nothing; nothing if u is not a knot that can go (ends, and the start of a periodic row, cannot).  [PT97 A5.8]
struct Removal {
  Row row;
  double misfit = 0.0;
};
std::optional<Removal> without_knot(const Row& row, double u);

/// The same row of a degree higher by `times`; every knot is there `times` times more.  [PT97 A5.9]
/// @throws std::invalid_argument beyond kHighestDegree
Row elevated(const Row& row, int times);
/// The row of one degree less, every knot there once less, whose elevation is nearest to it, and how far the weighted
/// points of that are away at most. Nothing for degree 1.  [PT97 A5.11]
std::optional<Removal> reduced(const Row& row);

/// A periodic row opened at u: clamped, from u on to u a period later. A clamped row as it is.
Row opened(const Row& row, double u);
/// The part from a to b of a clamped row, clamped.
Row part(const Row& row, double a, double b);
/// Two clamped rows of one degree, the second from where the first ends: their joint is a knot repeated `degree` times,
/// and the second's domain begins where the first's ends. The last point of the first stands for the second's first.
Row joined(const Row& a, const Row& b);
/// The same run through from its end to its start, over the same domain.
Row reversed(const Row& row);

}  // namespace trocar::geometry::nurbs
