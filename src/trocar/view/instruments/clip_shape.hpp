// A ligating clip of titanium, medium-large: two legs joined by a bend, a chevron when it lies open in its applier,
// two parallel legs when it is closed.
#pragma once

#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

/// Legs along +z from the bend at 0, opening along x, `gap` [m] more between their ends than when closed.
/// Always the same number of vertices, so that a closing clip is a moving mesh.
MeshBuffer clip_shape(double leg_length, double gap);

}  // namespace trocar::view
