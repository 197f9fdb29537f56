// How a thin fold between a tube and its root is patterned, for drawing one from a mesh: the renderer samples
// vessels and noise in rest coordinates, and a fold's are its own, (along the tube, from the tube to the root).
//
//   rest[i] = fold_rest(s, v);    paint[i] = fold_paint(s, v);          // look "mesosalpinx"
//   item.translucent = true;
#pragma once

#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

/// Length of one bow of the vessel arcade along the fold [m].
inline constexpr double kFoldTile = 0.06;

/// Rest coordinates of a fold's vertex. @param s arc length on the tube [m] @param v 0 at the tube .. 1 at the root.
/// For materials with `arcade`; their vessel_tile is kFoldTile.
Vec3f fold_rest(double s, double v);
/// Denser and fatty along both borders, thin between.
Paint fold_paint(double s, double v);

}  // namespace trocar::view
