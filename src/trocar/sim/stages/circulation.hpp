// Stages: vessels go with what carries them, the pulse moves it, blood flows and leaves by what is open. And what jaws
// and tears do to vessels, for the stages that work these.
#pragma once

#include <trocar/sim/bodies/parting.hpp>
#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Where vessels with a pulse are (Work::vessel_points).
void pose_vessels(StepContext& context) noexcept;
/// Where a vessel is. One without a pulse is posed when somebody asks for the first time in a tick.
const std::vector<Vec3d>& points_of(StepContext& context, size_t vessel) noexcept;

/// The pulse moves what carries vessels: where a vessel bends, a pressure above the mean pushes it outwards.
void beat(StepContext& context) noexcept;

/// A tick of blood flow with the openings and clips of the State; Work::bleeds says what leaves, where, which way.
void let_blood_flow(StepContext& context) noexcept;

/// Which vessels a blade opens.
/// @param carrier  those that ride on that body; none: on whatever is cut without flesh
/// @param hand     -1: it tears
void open_vessels(StepContext& context, const geometry::Blade& blade, BodyId carrier, int hand) noexcept;
/// A strand has been cut through in `element`: so are the vessels within it.
void open_vessels_within(StepContext& context, int strand, int element, int hand) noexcept;
/// Those of what a body has lost its hold of.
void open_vessels(StepContext& context, BodyId body, const Parting& parting, int hand) noexcept;

/// A clip has been set: what it closes of vessels. Where no strand lay between its legs, it may lie on a vessel.
void clip_vessels(StepContext& context, size_t hand, int clip) noexcept;

}  // namespace trocar::sim
