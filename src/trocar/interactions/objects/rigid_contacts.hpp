// Contacts of rigid bodies in a tick: found for beads, solved for all bodies together.
#pragma once

#include <trocar/interactions/objects/rigid.hpp>

namespace trocar::interactions {

/// Beads near walls, instruments and beads of others.
void find_contacts(const RigidModels& models, const Rigid::States& states, double tick, RigidWork& work) noexcept;
/// Impulses by projected Gauss-Seidel, and RigidWork::motion with them.
void solve_contacts(double tick, RigidWork& work) noexcept;

}  // namespace trocar::interactions
