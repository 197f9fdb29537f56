// A sheet of triangles with one rim laid on the unit square: the rim goes along the four edges, from four corners that
// lie farthest out in the sheet's principal plane, and inside each vertex is in the middle of its neighbours, so that
// nothing folds over.  [Tutte 1963, How to draw a graph; Pinkall & Polthier's weights, see laplace.hpp]
#pragma once

#include <array>
#include <vector>

#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry::nurbs {

struct SquareMap {
  std::vector<std::array<double, 2>> parameters;  ///< (u, v) of each vertex, u x v along the triangles' normals
  double way_u = 0.0, way_v = 0.0;                ///< mean lengths of opposite edges [m]
};

/// @throws std::invalid_argument for meshes in pieces, with handles, or with not exactly one rim
SquareMap map_to_square(const TriMesh& mesh);

}  // namespace trocar::geometry::nurbs
