// Triangles divided into four alike, by the middles of their edges.
//
//   const Quartered finer = quartered(mesh.triangles, int(mesh.positions.size()));
//   for (const auto& [a, b] : finer.halved)
//     mesh.positions.push_back(0.5 * (mesh.positions[a] + mesh.positions[b]));
//   mesh.triangles = finer.triangles;
#pragma once

#include <array>
#include <span>
#include <vector>

namespace trocar::geometry {

struct Quartered {
  std::vector<std::array<int, 3>> triangles;  ///< four for each: at its corners, then the middle one
  std::vector<std::array<int, 2>> halved;     ///< ends (lower, higher) of the edges whose middles are the new vertices
};

/// Triangles that share an edge share its middle. Surfaces keep their orientation.
/// @param vertices how many there are: the first new one has this number
Quartered quartered(std::span<const std::array<int, 3>> triangles, int vertices);

}  // namespace trocar::geometry
