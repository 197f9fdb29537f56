// On which side of a plane or line a point lies, without rounding: the sign is that of the exact value of the
// determinant. What asks such questions in a row (do these triangles cross?) gets answers that agree with each other.
//
//   if (side_of_plane(a, b, c, d) > 0) ...    // d sees a, b, c run counter-clockwise: outside
//
// First in doubles with a bound of the error; where that does not decide, in sums of doubles that lose nothing
// [Shewchuk 1997, Adaptive precision floating-point arithmetic and fast robust geometric predicates]. Exact unless a
// product of three coordinates is beyond 1e300 or, not being 0, below 1e-290.
#pragma once

#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry {

/// The sign of (b - a) x (c - a) . (d - a): 1 where d lies on the side from which a, b, c run counter-clockwise, -1 on
/// the other, 0 in the plane.
int side_of_plane(Vec3d a, Vec3d b, Vec3d c, Vec3d d);

/// The sign of (b - a) x (c - a) in the plane of two axes: 1 where c lies to the left of the way from a to b.
int side_of_line(Vec3d a, Vec3d b, Vec3d c, int first_axis, int second_axis);

}  // namespace trocar::geometry
