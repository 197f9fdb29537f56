// Stage: jaws grip, set clips, cut.
#pragma once

#include <trocar/sim/step.hpp>

namespace trocar::sim {

void work_jaws(StepContext& context) noexcept;

}  // namespace trocar::sim
