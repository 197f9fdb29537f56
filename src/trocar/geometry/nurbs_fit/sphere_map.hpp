// A closed mesh without handles laid on the globe: each vertex gets a longitude u (0 .. 1 around) and a latitude v (0
// at the south pole, 1 at the north pole), so that neighbours stay neighbours whatever bends and bulges the body has.
//
//   const SphereMap map = map_to_sphere(mesh, poles_along_longest_axis(mesh));
//
// Latitude is the temperature of a shell that is cold at one pole and warm at the other, longitude the same around,
// with a step of one turn at a date line; latitude is then rescaled to run in proportion to the mean way along the
// body. [Brechbuehler, Gerig & Kuebler 1995, Parametrization of closed surfaces for 3-D shape description; the
// rescaling is our choice, and weights are cotangents, kept above 0, instead of ones]
#pragma once

#include <array>
#include <vector>

#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry::nurbs {

struct SphereMap {
  std::vector<double> u;  ///< in [0, 1), growing eastwards: counter-clockwise seen from the north; 0 at the poles
  std::vector<double> v;  ///< in [0, 1]
  double length = 0.0;    ///< mean way from pole to pole [m]
  double around = 0.0;    ///< mean way around [m]
};

/// The vertices farthest apart along the longest principal axis: south and north pole.
std::array<int, 2> poles_along_longest_axis(const TriMesh& mesh);
/// The vertices farthest apart along edges, as far as going from one end to the other twice finds them: for bags with
/// an outer and an inner side.
std::array<int, 2> poles_farthest_along_edges(const TriMesh& mesh);
/// The vertex nearest to a place.
int nearest_vertex(const TriMesh& mesh, Vec3d place);

/// @throws std::invalid_argument for meshes that are open, in pieces, have handles, or the poles of which are
/// neighbours
SphereMap map_to_sphere(const TriMesh& mesh, std::array<int, 2> poles);

}  // namespace trocar::geometry::nurbs
