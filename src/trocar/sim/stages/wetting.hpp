// Stages of the fluids: drops push tissue; what bleeds and what suction-irrigators give becomes drops that fly, land on
// tissue and instruments, run down, leave a film, gather, and are sucked away.
#pragma once

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Impulses of drops on tissue in the last tick (State::impacts) push it in this one.
void apply_drop_impacts(StepContext& context) noexcept;

void move_fluids(StepContext& context) noexcept;

}  // namespace trocar::sim
