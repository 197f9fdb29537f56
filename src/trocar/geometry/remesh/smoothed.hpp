// A surface is smoothed and keeps its volume: passes that shrink and passes that swell in turn [Taubin 1995, A signal
// processing approach to fair surface design], and at the end a shift along the normals that gives back what is
// missing.
//
//   const Smoothed organ = smoothed(mesh, 10);
//   say(organ.volume_before, organ.volume);
#pragma once

#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry {

struct SmoothOptions {
  double shrink = 0.5, swell = 0.526;  ///< of the way to the mean of the neighbours, and back
  bool keep_volume = true;             ///< of closed meshes
};

struct Smoothed {
  TriMesh mesh;
  double volume_before = 0, volume = 0;  ///< [m^3]
  double farthest = 0;                   ///< [m] that a vertex has moved
};
/// Vertices on borders stay where they are.
Smoothed smoothed(const TriMesh& mesh, int passes, const SmoothOptions& options = {});

}  // namespace trocar::geometry
