// What jaws, current and tears do to vessels in and on bodies: blades open them, clips close them.
#pragma once

#include <trocar/sim/bodies/parting.hpp>
#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

inline const interactions::VesselPath& path_of(const StepContext& c, size_t vessel) noexcept {
  return c.model.vessels.list[vessel].path;
}
/// Where a vessel is. One without a pulse is posed when somebody asks for the first time in a tick.
const std::vector<Vec3d>& points_of(StepContext& context, size_t vessel) noexcept;

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

/// Where a vessel runs within a strand at that arc length of it [m]: its s; below 0: it does not.
double place_within(const StepContext& context, int strand, std::size_t vessel, double arc) noexcept;

/// The vessel that opens by itself, in its tick.
void open_bleeder(StepContext& context) noexcept;

}  // namespace trocar::sim
