// What a pouch loses: by a duct whose lumen opens into it and that was parted without a clip on the pouch's side, and
// the stones in it, by a hole in its wall that is wide enough.
#pragma once

#include <trocar/sim/bodies/bodies.hpp>
#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Takes from the pouch what runs out by its duct in this tick. Nothing while the duct leads on, or is closed by a clip
/// between the pouch and the nearest place where it is parted; a clip that leaves some of the lumen leaves so much.
tissue::Leak leak_by_duct(const StepContext& c, MembraneRef r) noexcept;

/// Stage: stones lie in the middle of what encloses them until one falls out, where the wall is open. One passes that
/// is no thicker than the hole, as a circle of its area is wide, while something runs out or the hole faces down, and
/// no other one is in the way; of several the first.
void update_spilled_stones(StepContext& c) noexcept;

}  // namespace trocar::sim
