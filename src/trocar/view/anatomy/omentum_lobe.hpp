// The lower border of the omentum where it hangs into the pelvis: a sheet of fat that lies slack over whatever is below
// it and ends in a free, rounded border. Drawing only; it does not move.
#pragma once

#include <span>
#include <vector>

#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

/// Seen from above. Both lines have as many points, no two of one in the same place.
struct LobeOutline {
  std::vector<Vec3d> border;  ///< the free one
  std::vector<Vec3d> root;    ///< where it comes from, out of view
};

/// @param below points on what it lies on, a few millimetres apart @param up unit
MeshBuffer omentum_lobe(const LobeOutline& outline, std::span<const Vec3d> below, Vec3d up);

}  // namespace trocar::view
