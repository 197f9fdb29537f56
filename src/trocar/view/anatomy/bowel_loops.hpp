// Bowel that is not simulated: below the border of a wall that is a floor there would be an empty bowl. The large bowel
// continues out of view at both ends, loops of small bowel lie on the other side of it, the omentum's border hangs over
// both. Drawing only; they do not move, instruments pass through them.
#pragma once

#include <trocar/view/base/mesh_buffer.hpp>
#include <trocar/view/bodies/wall_surface.hpp>

namespace trocar::view {

struct BowelLoops {
  MeshBuffer small;
  MeshBuffer large;    ///< what continues from its end at the border, then from its other end
  MeshBuffer omentum;  ///< hangs over them
};

/// Empty where no organ of the scene is large bowel that they could lie beside, or no border is a floor.
BowelLoops bowel_loops(const sim::Model& model, const WallSurface& walls);

}  // namespace trocar::view
