// The borders of a surface, as loops of edges that have one triangle: what a hole is seen by.
//
//   for (const Rim& rim : rims_of(mesh, edges)) close(rim.vertices);
//
// A vertex at which several borders meet is in each of them, once for every fan of triangles around it.
#pragma once

#include <vector>

#include <trocar/geometry/surfaces/edge_table.hpp>

namespace trocar::geometry {

struct Rim {
  std::vector<int> vertices;   ///< along the sides of the first one's triangle: what closes the rim runs the other way
  std::vector<int> triangles;  ///< the one at the edge from each vertex to the next
  double length = 0;           ///< [m]
  bool is_loop = true;         ///< false where it ends at an edge with more than two triangles
};
/// In the order of their first triangles.
std::vector<Rim> rims_of(const TriMesh& mesh, const EdgeTable& edges);

/// Six times the volume, and twice the area, that a fan from the rim's middle has which closes it; volumes as seen
/// from `origin`.
double fan_six_volumes(const TriMesh& mesh, const Rim& rim, Vec3d origin);
double fan_twice_area(const TriMesh& mesh, const Rim& rim);

}  // namespace trocar::geometry
