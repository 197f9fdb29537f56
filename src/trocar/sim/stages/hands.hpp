// Stages: instruments and endoscope follow the input; at the end of a tick, what the tissue did to them.
#pragma once

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Instruments and scope follow the input, no faster than hands can.
void move_hands(StepContext& context) noexcept;
/// What the tissue did to the instruments; slip.
void feel(StepContext& context) noexcept;

/// A grip has ended: tells whether it slipped, or the hand let go.
void tell_lost(StepContext& context, size_t hand, int slips_before) noexcept;

}  // namespace trocar::sim
