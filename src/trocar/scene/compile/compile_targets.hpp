// What exercises may ask to be seen, as samples that the step looks at in turn: jaws and shafts of the hands, named
// stretches of strands, organs.
#pragma once

#include <trocar/sim/model/model.hpp>

namespace trocar::scene {

/// Fills Model::targets and Model::samples; hands, strands and solids are there already.
void compile_targets(sim::Model& model);

}  // namespace trocar::scene
