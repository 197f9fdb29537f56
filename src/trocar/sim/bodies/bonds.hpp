// Bonds: what ties walls to what they lie on, and comes apart (interactions/couplings/bonds.hpp).
#pragma once

#include <trocar/geometry/tets/blade.hpp>
#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Stage: bonds pull, and give way where they are opened too far.
void pull_on_bonds(StepContext& context) noexcept;

/// Bonds between whose ends the blade passes hold no more. @return how many
int sever_bonds(StepContext& context, const geometry::Blade& blade) noexcept;

/// Bonds at an electrode that current leaves from shrivel and part, all within a fifth of a second.
/// @param dt  for how long it has been there [s]
void burn_bonds(StepContext& context, Vec3d electrode, double dt) noexcept;

}  // namespace trocar::sim
