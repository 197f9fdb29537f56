// How far each voxel of a box is from the nearest one in a set, or out of it: the exact Euclidean distance between
// centres, in time proportional to the voxels. [Felzenszwalb & Huttenlocher 2012, Distance transforms of sampled
// functions, Theory of Computing 8]
#pragma once

#include <trocar/volumes/segment/voxel_set.hpp>

namespace trocar::volumes {

/// Squared [mm^2], of the box's voxels; very large (1e20) where there is no voxel to be near to.
/// @param to_outside  false: to the nearest voxel in the set; true: to the nearest of the box that is not
/// @param spacing     [mm]
/// @param border_is_outside  what lies beyond the box counts as not in the set
std::vector<float> squared_distance(const VoxelSet& set, Vec3d spacing, bool to_outside,
                                    bool border_is_outside = false);

}  // namespace trocar::volumes
