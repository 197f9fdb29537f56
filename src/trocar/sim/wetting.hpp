// Stage: fluids. What bleeds becomes drops that fly, land on tissue and instruments, run down, leave a film, gather.
#pragma once

#include <trocar/sim/step.hpp>

namespace trocar::sim {

void move_fluids(StepContext& context) noexcept;

}  // namespace trocar::sim
