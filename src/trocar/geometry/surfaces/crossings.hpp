// Where a surface passes through itself: pairs of triangles with a point in common that is no corner and no edge of
// both. Decided without rounding (orientation.hpp), so the answer is the same everywhere, and sheets that only come
// near each other do not count.
//
//   const Crossings found = self_crossings(mesh);
//   for (const auto& [a, b] : found.pairs) ...
//
// TriangleCorners are the same where their places are, whatever their numbers: seams that were split do not cross. What
// touches, crosses: a corner on another triangle, an edge on another edge. Triangles without area cross nothing, and
// two of the same three corners are duplicates, which examine() tells apart.
#pragma once

#include <array>
#include <vector>

#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry {

inline constexpr int kMostCrossings = 20'000;  ///< pairs that are reported
/// Pairs that are looked at: so many, or as many times the number of triangles if that is more.
inline constexpr long long kMostCrossingTests = 10'000'000, kMostCrossingTestsEach = 60;

struct Crossings {
  std::vector<std::array<int, 2>> pairs;  ///< triangles, ascending, the lower one first
  bool all = true;                        ///< or it stopped at one of the bounds above
};
/// @param mesh  coordinates finite; where they are not, the triangle crosses nothing
Crossings self_crossings(const TriMesh& mesh);

using TriangleCorners = std::array<Vec3d, 3>;
bool triangles_cross(const TriangleCorners& p, const TriangleCorners& q);

}  // namespace trocar::geometry
