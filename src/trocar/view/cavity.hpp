// The rest of the body cavity around a scene: a large, smooth, dark-red space, so that a picture never shows nothing
// where the scene file's walls end.
#pragma once

#include <trocar/sim/model.hpp>
#include <trocar/view/mesh_buffer.hpp>

namespace trocar::view {

/// An egg around all organs, walls and ports, seen from inside.
MeshBuffer cavity_around(const sim::Model& model);

}  // namespace trocar::view
