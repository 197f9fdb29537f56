// How bodies, their pieces and their parts push each other apart where they touch: springs and dashpots between a
// vertex of a skin and what lies in it, implicit on both sides, along the normal. Across it there is body_friction.hpp.
#pragma once

#include <trocar/interactions/bodies/loads.hpp>
#include <trocar/interactions/bodies/surface.hpp>

namespace trocar::interactions {

inline constexpr double kBodyStiffness = 150;      ///< [N/m] per sample of pieces among each other
inline constexpr double kBodyDamping = 0.05;       ///< [N s/m]
inline constexpr double kPressStiffness = 1500;    ///< [N/m] per sample of bodies: few samples bear a whole limb
inline constexpr double kPressDamping = 1.5;       ///< [N s/m] against what both sides do together: nothing bounces
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

/// The same, of bodies on each other. @param by  [m] along n  @param speed  along n, that both have together [m/s]
inline void press_vertex(const Surface& surface, int vertex, double by, Vec3d n, double speed,
                         NetworkLoads& loads) noexcept {
  SkinLoad load;
  load.k = kPressStiffness;
  load.shift = by * n;
  load.dir = n;
  load.d = kPressDamping;
  load.f0 = (kPressDamping * speed) * n;
  add_skin_load(surface.nodes, *surface.skin, vertex, load, {Owner::body, 0, 0}, loads);
}
/// The same on a rod. @param x0  where the point of it shall be
inline tissue::StrandLoad press_strand(int element, double w, Vec3d x0, Vec3d n, double speed) noexcept {
  tissue::StrandLoad load;
  load.element = element;
  load.w = w;
  load.k = kPressStiffness;
  load.dir = n;
  load.d = kPressDamping;
  load.f0 = (kPressDamping * speed) * n;
  load.x0 = x0;
  return load;
}

}  // namespace trocar::interactions
