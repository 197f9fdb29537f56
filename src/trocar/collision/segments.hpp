// Distances between rods: closest points of two segments, and of a point and a segment. Robust for zero lengths and
// parallel rods.  [Ericson 05, ch. 5]
#pragma once

#include <trocar/numerics/vec3.hpp>

namespace trocar::collision {

struct SegmentPair {
  double s = 0, t = 0;  ///< parameters on the first and second segment, 0..1
  Vec3d on_first, on_second;
  double distance = 0;
};

/// Parameter in 0..1 of the point of segment ab nearest to p.
double nearest_on_segment(Vec3d a, Vec3d b, Vec3d p) noexcept;

SegmentPair nearest_segments(Vec3d a0, Vec3d a1, Vec3d b0, Vec3d b1) noexcept;

/// Does the segment from->to pass within `radius` of the segment ab?
bool passes_within(Vec3d from, Vec3d to, Vec3d a, Vec3d b, double radius) noexcept;

}  // namespace trocar::collision
