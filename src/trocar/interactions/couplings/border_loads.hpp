// Where a membrane hangs: every node of its borders rides on a strand, on an organ's skin, or stays in space. The node
// is exactly where its holder is when the tick ends; the holder bears what the sheet pulls with.
//
// Holders step before the sheet does, with its pull at the tick's beginning. To hold a stiff sheet with a light holder
// they resist changes of their velocity beside that, implicitly: an inertia of added_damping() x dt. A holder of mass m
// with the border's own stiffness k and damping d is stable from 1/4 k dt^2 and 1/2 d dt on, however small m; what the
// inertia differs from the sheet's own is momentum that goes astray while the holder's speed changes (a test bounds
// it).
#pragma once

#include <span>

#include <trocar/interactions/bodies/bodies.hpp>

namespace trocar::interactions {

/// Where the node shall be: on its holder as that is now.
Vec3d held_place(const BorderHold& hold, const Bodies& bodies) noexcept;
/// Where on its holder it is rooted [m].
Vec3d foot_of(const BorderHold& hold, const Bodies& bodies) noexcept;
/// How fast its holder moves there [m/s].
Vec3d held_velocity(const BorderHold& hold, const Bodies& bodies) noexcept;

/// Gives a force to the holder, and a resistance `d` to changes of its velocity there [N s/m]. Nothing to space.
void bear(const BorderHold& hold, Vec3d force, double d, const Bodies& bodies) noexcept;

/// What a border node resists its holder's changes of velocity with [N s/m].
double added_damping(const tissue::BorderPull& pull, double dt) noexcept;

/// Gives the sheet's pulls to the holders.
/// @param holds, pulls  (held nodes of the membrane)
void border_loads(std::span<const BorderHold> holds, std::span<const tissue::BorderPull> pulls,
                  const tissue::MembraneModel& sheet, const tissue::MembraneState& state, const Bodies& bodies,
                  double dt) noexcept;

}  // namespace trocar::interactions
