// Bonds: what ties walls to what they lie on, and comes apart (interactions/couplings/bonds.hpp).
#pragma once

#include <trocar/geometry/tets/blade.hpp>
#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Stage: bonds pull, and give way where they are opened too far.
void apply_bond_loads(StepContext& context) noexcept;

/// Bonds between whose ends the blade passes hold no more. @return how many
int sever_bonds(StepContext& context, const geometry::Blade& blade) noexcept;

/// Bonds at an electrode that current leaves from shrivel and part, all within a fifth of a second; where they had
/// parted before, the raw surface dries.
/// @param dt  for how long it has been there [s]
void burn_bonds(StepContext& context, Vec3d electrode, double dt) noexcept;

/// Fluid that has been injected near a plane loosens what bridges it: oedema between wall and bed.
/// @param at  the needle's point [m]; @param volume  that has come in this time [m^3]; @param spread  sigma of where
/// [m]
void loosen_bonds(StepContext& context, Vec3d at, double volume, double spread) noexcept;

/// Blood that oozes into the film on an organ where bonds of a set have been torn or cut off it. One bond after the
/// other has its turn, with what all of them would have oozed since its last.
struct Ooze {
  Vec3d place;                  ///< [m]
  std::int32_t film = -1;       ///< place of film (WetModel::film)
  std::int64_t picolitres = 0;  ///< in this tick
};
Ooze ooze_from_bonds(StepContext& context, size_t set) noexcept;

}  // namespace trocar::sim
