// Stages: vessels move with the bodies that carry them, the pulse moves those, blood flows and leaves by openings.
#pragma once

#include <trocar/sim/bodies/vessel_wounds.hpp>
#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Where vessels with a pulse are (Work::vessel_points).
void pose_vessels(StepContext& context) noexcept;

/// The pulse moves what carries vessels: where a vessel bends, a pressure above the mean pushes it outwards.
void apply_pulse_loads(StepContext& context) noexcept;

/// A tick of blood flow with the openings and clips of the State; Work::bleeds says what leaves, where, which way.
void update_blood_flow(StepContext& context) noexcept;

}  // namespace trocar::sim
