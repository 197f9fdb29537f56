// Triangles that close a loop of edges without new vertices: of all ways to do so the one whose worst angle between
// neighbours is least, then the one of least area [Barequet & Sharir 1995; Liepa 2003]. What is asked of n corners in
// n^3 / 6 triangles, so that long loops are shortened first by cutting off the corners that cost least.
//
//   const auto triangles = rim_patch(loop);              // in numbers of the loop's corners
#pragma once

#include <array>
#include <functional>
#include <vector>

#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry {

struct PatchLoop {
  std::vector<Vec3d> places;   ///< in the direction in which the patch runs along its border
  std::vector<Vec3d> normals;  ///< of the triangle outside of the edge from each corner to the next, or 0 0 0
  /// Whether the corners i and j have an edge elsewhere: the patch must not have it as well.
  std::function<bool(int i, int j)> taken;
};
inline constexpr int kMostPatchCorners = 200;  ///< that are all tried with each other

/// n - 2 triangles; none where every way would use a taken edge, or where there are less than three corners.
std::vector<std::array<int, 3>> rim_patch(const PatchLoop& loop);

}  // namespace trocar::geometry
