// Stage: muscles of hollow organs contract (the model of it: sim/model/motion.hpp).
#pragma once

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

void apply_peristalsis(StepContext& c) noexcept;

}  // namespace trocar::sim
