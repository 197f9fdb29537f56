// Shapes as fields: how far inside (above 0) or outside (below 0) a point is. What stuffing.hpp fills with cells, from
// a closed triangle mesh or from voxels.
//
//   const Field organ = field_of(closed_mesh);             // the exact distance
//   const Field liver = field_of_label(volume, 5);         // voxels.hpp
//   if (organ.inside(p) > 0) ...
//
// The same bits from every compiler. Lengths in metres.
#pragma once

#include <functional>
#include <limits>

#include <trocar/geometry/surfaces/tri_mesh.hpp>
#include <trocar/geometry/volumes/voxels.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry {

struct Field {
  /// Above 0 inside, 0 on the surface, below 0 outside; near the surface about proportional to the distance.
  std::function<double(Vec3d)> inside;
  Bounds box;  ///< the shape is within
  /// Within a metre the field changes by at most this; infinite where nobody knows. Spares looking at every place.
  double steepest = std::numeric_limits<double>::infinity();
};

/// The distance to the nearest triangle, negative outside. Outside is what no surface goes around: where the mesh
/// overlaps itself, whatever is inside at least once counts as inside. The sign is right for every point more than
/// 2^-29 of the box's longest side away from the surface. Throws std::invalid_argument for a mesh that is open, without
/// volume, or that faces inwards.
Field field_of(const TriMesh& closed);

/// How far a point is from the nearest triangle of a mesh, open or closed. Throws std::invalid_argument for one without
/// triangles.
std::function<double(Vec3d)> distance_to(const TriMesh& mesh);

inline constexpr int kMostSmoothing = 16;

/// The voxels that carry this label, their steps smoothed away: the share of the label (1 or 0) is averaged with the
/// weights 1 2 1 along each axis `smoothing` times and continued trilinearly between the voxels' centres; the surface
/// is where it is one half. Flat faces stay midway between voxels. Curved ones move towards their inside by `smoothing`
/// voxel^2 / 2 R, R the radius of a sphere: one pass costs a ball of radius 10 voxels 1.5 % of its volume. A plate of
/// one voxel is lost by one pass, a rod of 2 x 2 by 2. What the volume's border cuts ends there.
/// Throws std::invalid_argument where no voxel has the label.
Field field_of_label(const Voxels& voxels, int label, int smoothing = 1);

/// The voxels above a threshold, trilinear between their centres, not smoothed. Throws std::invalid_argument where no
/// voxel is.
Field field_above(const Voxels& voxels, double threshold);

}  // namespace trocar::geometry
