// Holes of a mesh closed by fans around the middles of their rims: parts of anatomical models are cut open where they
// go over into each other.
//
//   const TriMesh closed = filled_holes(merged_vertices(parts, 1e-6));
#pragma once

#include <vector>

#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry {

/// The vertices around each hole, in the direction in which its triangles would use them; holes by their lowest vertex.
/// @throws std::invalid_argument where rims touch in a vertex or triangles are turned against each other
std::vector<std::vector<int>> rims(const TriMesh& mesh);

/// The mesh with a vertex in the middle of each rim and triangles from there. Vertices that were there keep their
/// number.
TriMesh filled_holes(const TriMesh& mesh);

}  // namespace trocar::geometry
