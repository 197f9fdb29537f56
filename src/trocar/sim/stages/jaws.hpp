// Stage: jaws grasp, set clips, cut.
#pragma once

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

void actuate_jaws(StepContext& context) noexcept;

}  // namespace trocar::sim
