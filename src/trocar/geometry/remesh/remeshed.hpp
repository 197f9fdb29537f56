// A surface of triangles that are all about alike: edges of one length, angles near 60 degrees. What springs and
// pictures want, and what smooths slivers away.
//
//   const Remeshed even = remeshed(mesh, 0.002);      // edges of 2 mm
//
// Long edges are split, short ones collapse, edges are flipped until vertices have six of them, vertices move along the
// surface to the middle of their neighbours and back onto the surface that was given [Botsch & Kobbelt 2004]. It stays
// the manifold that it was. Sharp edges and borders stay where they are: their vertices move along them at most.
#pragma once

#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry {

struct RemeshOptions {
  int rounds = 6;
  double sharp_deg = 50;  ///< edges at which the surface turns by more are kept
  int most_triangles = 2'000'000;
};

struct Remeshed {
  TriMesh mesh;
  double mean_edge = 0;                  ///< [m]
  double least_angle = 0;                ///< [degrees]
  double volume_before = 0, volume = 0;  ///< [m^3]
  double farthest = 0;                   ///< [m] of a vertex or of a triangle's middle from the surface that was given
};
/// @param edge  [m] > 0. Throws std::invalid_argument where the surface would have more than most_triangles.
Remeshed remeshed(const TriMesh& mesh, double edge, const RemeshOptions& options = {});

}  // namespace trocar::geometry
