// Stage: jaws grip, set clips, cut.
#pragma once

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

void work_jaws(StepContext& context) noexcept;

}  // namespace trocar::sim
