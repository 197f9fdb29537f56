// How bodies, their pieces and their parts push each other apart where they touch: springs and dashpots between a
// vertex of a skin and what lies in it, implicit on both sides, along the normal. Across it there is body_friction.hpp.
#pragma once

#include <trocar/interactions/bodies/loads.hpp>
#include <trocar/interactions/bodies/surface.hpp>

namespace trocar::interactions {

inline constexpr double kBodyStiffness = 150;      ///< [N/m] per sample of organs and of pieces among each other
inline constexpr double kBodyDamping = 0.05;       ///< [N s/m]
inline constexpr double kQuickestApart = 0.0006;   ///< [m] a tick that two of them are moved apart
inline constexpr double kDeepestContact = 0.010;   ///< [m] deeper is not contact but another side of the body
inline constexpr double kFarthestContact = 0.012;  ///< [m] further from the nearest vertex, its plane says nothing

/// Pushes a skin vertex along n.
/// @param by  what is still lacking [m]
inline void push_skin(const Surface& surface, int vertex, Vec3d by, Vec3d n, double stiffness, double damping,
                      NetworkLoads& loads) noexcept {
  SkinLoad load;
  load.k = stiffness;
  load.shift = by;
  load.dir = n;
  load.d = damping;
  add_skin_load(surface.nodes, *surface.skin, vertex, load, {Owner::body, 0, 0}, loads);
}

}  // namespace trocar::interactions
