// Stage: instruments and endoscope follow the input.
#pragma once

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Instruments and scope follow the input, no faster than hands can.
void move_hands(StepContext& context) noexcept;

/// A grip has ended: tells whether it slipped, or the hand let go.
void tell_lost(StepContext& context, size_t hand, int slips_before) noexcept;

}  // namespace trocar::sim
