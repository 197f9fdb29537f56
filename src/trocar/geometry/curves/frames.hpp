// Frames that turn along a polyline as little as possible (parallel transport by double reflection), for tubes, vessels
// and threads: no twist where the line is straight or passes an inflection, unlike Frenet's.
// [Wang, Juettler, Zheng & Liu 2008, Computation of rotation minimizing frames]
//   std::vector<Frame> frames(points.size());
//   transport_frames(points, {0, 0, 1}, frames);
// Made for the step: double, noexcept, no allocation.
#pragma once

#include <span>

#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry {

/// Orthonormal, right-handed: binormal = tangent x normal.
struct Frame {
  Vec3d tangent, normal, binormal;
};

/// Unit direction of the line at each point: along the segment at the ends, halfway between the two segments' unit
/// directions inside. Repeated points take the direction of their neighbourhood.
void line_tangents(std::span<const Vec3d> points, std::span<Vec3d> tangents) noexcept;

/// Frames at every point, the first one's normal as near to `first_normal` as its tangent allows. frames: as many as
/// points, overwritten.
void transport_frames(std::span<const Vec3d> points, Vec3d first_normal, std::span<Frame> frames) noexcept;

/// The frame `from` carried from point p to point q, where the tangent is `tangent` (unit).
Frame transported(const Frame& from, Vec3d p, Vec3d q, Vec3d tangent) noexcept;

/// A frame about the unit tangent with its normal as near to `wished_normal` as possible.
Frame frame_about(Vec3d tangent, Vec3d wished_normal) noexcept;

}  // namespace trocar::geometry
