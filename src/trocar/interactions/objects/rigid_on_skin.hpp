// Rigid bodies on tissue: beads sink into skins that give way, as organs do into each other (contact/body_push.hpp).
// Half of what a bead lacks is the skin's to give, half the bead's, each by the same spring.
#pragma once

#include <trocar/interactions/bodies/surface.hpp>
#include <trocar/interactions/objects/rigid.hpp>

namespace trocar::interactions {

/// Beads in the surface: noted for the bodies, and loads for what the skin belongs to.
void rest_on_skin(const RigidModels& models, const Rigid::States& states, const Surface& surface, NetworkLoads& loads,
                  RigidWork& work) noexcept;

}  // namespace trocar::interactions
