// A surface that passes through itself is made again from what it encloses: the field of distances (volumes/field.hpp)
// is filled with cells (tets/stuffing.hpp), and their skin is the new surface. Also a sheet gets a thickness that way.
//
//   const Refilled body = refilled(mesh);                     // as fine as the mesh is, as far as that is bounded
//   const Refilled wall = thickened(sheet, 0.002);            // 2 mm
//
// All detail finer than the cells is lost, sharp edges are cut off by up to half a cell; nothing else takes any mesh.
// Shells that overlap become one.
#pragma once

#include <string>

#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry {

struct RefillOptions {
  double cell = 0;             ///< [m] edge of the cubes; 0: three quarters of the mesh's mean edge
  int most_cells = 1'500'000;  ///< larger cubes where there would be more
};

struct Refilled {
  TriMesh mesh;         ///< closed; empty where nothing could be made, with the reason in `why`
  double cell = 0;      ///< [m] that it was made with
  double farthest = 0;  ///< [m] of the given mesh's vertices from the new surface
  std::string why;
};
/// @param mesh  each edge with two triangles that agree, facing outwards; otherwise nothing, with the reason
Refilled refilled(const TriMesh& mesh, const RefillOptions& options = {});

/// Everything that is nearer to the surface than half the thickness [m]. Any mesh, open or not.
Refilled thickened(const TriMesh& mesh, double thickness, const RefillOptions& options = {});

}  // namespace trocar::geometry
