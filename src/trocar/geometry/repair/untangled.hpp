// Where a surface passes through itself in a few places, these are eased or cut out, and the rest stays as it is: first
// the vertices about them are drawn to the middle of their neighbours, as folds at a crease ask for no more; then the
// triangles that cross go, with some around them, and the holes are closed [Attene 2010, A lightweight approach to
// repairing digitized polygon meshes].
//
//   const Repaired better = untangled(mesh);     // better.left where it is not enough: see refilled()
#pragma once

#include <trocar/geometry/repair/repaired.hpp>

namespace trocar::geometry {

/// Of a surface no more than this share is cut out.
inline constexpr double kMostCutOut = 0.25;

/// @param mesh  closed, each edge with two triangles that agree. What comes out is that, too, and has no more
/// crossings.
Repaired untangled(const TriMesh& mesh);

}  // namespace trocar::geometry
