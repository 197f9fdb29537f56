// Sheer films in the gaps of fat that is being taken apart: from lobule to lobule, and to the cords that lobules are
// rooted on, along septa and roots that hold. Each closes a notch: two places that have come apart, and the shortest
// way round from one to the other, by links that hold.
#pragma once

#include <utility>
#include <vector>

#include <trocar/numerics/vec3.hpp>
#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

/// What films hang on.
struct VeilFrame {
  std::vector<Vec3f> places, rest;         ///< [m]
  std::vector<std::pair<int, int>> links;  ///< that hold
};

/// From the first place to the last, each linked to the next; the border from the last back to the first is free.
using FatVeil = std::vector<int>;

/// @param spacing  from lobule to lobule [m]
std::vector<FatVeil> fat_veils(const VeilFrame& frame, float spacing);

/// Fainter where its places have hardly come apart, or are about to part.
void add_veil(const VeilFrame& frame, const FatVeil& veil, float spacing, MeshBuffer& to);

}  // namespace trocar::view
