// Walls with an outer and an inner surface end in two rims, one within the other: a bowel that was cut, a vessel. A
// ring of triangles between the two closes the wall and leaves the lumen open, where a lid on each would close that.
//
//   for (const auto& [outer, inner] : concentric_rims(mesh, rims)) add(rim_bridge(mesh, rims[outer], rims[inner]));
#pragma once

#include <array>
#include <vector>

#include <trocar/geometry/repair/rims.hpp>

namespace trocar::geometry {

/// Pairs of rims, each in one pair at most: about in one plane, one within the other, running opposite ways as the two
/// sides of a wall do.
std::vector<std::array<int, 2>> concentric_rims(const TriMesh& mesh, const std::vector<Rim>& rims);

/// The ring of least area between two of them, which joins on to the surfaces' triangles.
std::vector<std::array<int, 3>> rim_bridge(const TriMesh& mesh, const Rim& outer, const Rim& inner);

}  // namespace trocar::geometry
