// Tissue that is stretched beyond what it bears tears: organs and folds along the cells there, strands at an element.
#pragma once

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// A stage of the step. Every tear is an event.
void tear_tissue(StepContext& context) noexcept;

}  // namespace trocar::sim
