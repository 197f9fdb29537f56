// The faces of tetrahedra, sorted so that equal ones lie side by side: what a mesh's surface, parts and overlaps are
// read from. Used by tet_mesh.cpp and tet_repair.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <trocar/geometry/tets/tet_mesh.hpp>

namespace trocar::geometry {

struct TetFace {
  std::array<int, 3> nodes;  ///< ascending
  int cell;
  signed char opposite;  ///< which corner of the cell is not in it
  bool outwards;         ///< do ascending nodes run counter-clockwise seen from outside the cell?
};

/// The corners of the face opposite to corner k, counter-clockwise seen from outside an upright cell.
std::array<int, 3> face_of(const std::array<int, 4>& cell, int k, bool upright);

/// All faces of cells whose corners differ, sorted by nodes, then by cell.
std::vector<TetFace> sorted_faces(const TetMesh& mesh);

/// Calls f(span of equal faces) for every group.
template <class F>
void for_each_face(const std::vector<TetFace>& faces, F&& f) {
  for (std::size_t first = 0, last = 0; first < faces.size(); first = last) {
    while (last < faces.size() && faces[last].nodes == faces[first].nodes) ++last;
    f(std::span<const TetFace>(faces.data() + first, last - first));
  }
}

/// For every node the lowest-numbered node that it is one with: itself, or one within `distance` that is kept.
/// Nodes that are not `used` are one with nobody. A chain of near nodes does not become one place: what is kept is
/// more than `distance` apart.
std::vector<int> same_nodes(const std::vector<Vec3d>& points, const std::vector<bool>& used, double distance);

/// Which nodes cells have, and the diagonal of the box around these.
std::vector<bool> used_nodes(const TetMesh& mesh);
Bounds bounds_of(const std::vector<Vec3d>& points, const std::vector<bool>& used);
double diagonal(const Bounds& box);

/// Has the cell no volume to speak of, in a mesh of this diagonal?
bool is_flat(const TetMesh& mesh, int cell, double box_diagonal);

}  // namespace trocar::geometry
