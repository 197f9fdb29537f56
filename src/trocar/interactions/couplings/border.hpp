// Where a membrane hangs: every node of its borders rides on a rod, on an organ, or stays in space. The node is exactly
// where its attachment is when the tick ends; the attachment bears what the sheet pulls with, and what touches the node.
//
// Attachments step before the sheet does, with its pull at the tick's beginning. To hold a stiff sheet with a light
// body they resist changes of their velocity as the far end of every coupling does (coupled.hpp). A node that is
// exactly there is no mass of its own that could lag: a body of mass m with the border's stiffness k and damping d is
// stable from 1/4 k dt^2 and 1/2 d dt on, however small m, so that kBorderShare of the full resistance does. What the
// inertia differs from the sheet's own is momentum that goes astray while the attachment's speed changes (a test bounds
// it).
#pragma once

#include <span>

#include <trocar/interactions/bodies/bodies.hpp>
#include <trocar/interactions/couplings/coupled.hpp>

namespace trocar::interactions {

inline constexpr double kBorderShare = 0.35;

/// What a border node resists its attachment's changes of velocity with [N s/m].
double added_damping(const tissue::BorderPull& pull, double dt) noexcept;

/// Gives the sheet's pulls, and what has been put on its held nodes in this tick, to what it is attached to.
/// @param pulls  (held nodes of the membrane)
void border_loads(const Bodies& bodies, std::size_t membrane, std::span<const tissue::BorderPull> pulls,
                  double dt) noexcept;

}  // namespace trocar::interactions
