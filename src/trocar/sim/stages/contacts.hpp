// Stages: what touches what.
#pragma once

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Instruments on tissue: contact and hold.
void touch_tissue(StepContext& context) noexcept;
/// Organs on organs.
void touch_organs(StepContext& context) noexcept;

}  // namespace trocar::sim
