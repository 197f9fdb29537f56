// What has come apart of a body: by blades, by current, or because it tore.
#pragma once

#include <trocar/geometry/tets/blade.hpp>

namespace trocar::sim {

struct Parting {
  bool parted = false;
  geometry::Blade blade;  ///< that stands for it; of strands: none
  int element = -1;       ///< of a strand
  int moved = 0;          ///< nodes that snapped to the blade, and what parted
  double depth = 0;       ///< of a fold: how deep from its strand's surface, in the drawn shape [m]
};

}  // namespace trocar::sim
