// Stage: instruments and endoscope follow the input.
#pragma once

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Instruments and scope follow the input, no faster than hands can.
void move_hands(StepContext& context) noexcept;

}  // namespace trocar::sim
