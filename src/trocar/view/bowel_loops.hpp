// Loops of small bowel that lie where a wall's border is a floor: below the border nothing is simulated, and an empty
// bowl looks like a model's. Drawing only; they do not move, instruments pass through them.
#pragma once

#include <trocar/view/mesh_buffer.hpp>
#include <trocar/view/wall_surface.hpp>

namespace trocar::view {

/// Empty where no organ of the scene is large bowel that they could lie beside, or no border is a floor.
MeshBuffer bowel_loops(const sim::Model& model, const WallSurface& walls);

}  // namespace trocar::view
