// How bodies, their pieces and their parts push each other apart where they touch: springs and dashpots between a
// vertex of a skin and what lies in it, implicit on both sides, along the normal. Across it there is body_friction.hpp.
#pragma once

#include <trocar/interactions/bodies/loads.hpp>
#include <trocar/interactions/bodies/surface.hpp>

namespace trocar::interactions {

inline constexpr double kBodyStiffness = 150;      ///< [N/m] per sample of pieces among each other
inline constexpr double kBodyDamping = 0.05;       ///< [N s/m]
inline constexpr double kPressStiffness = 1500;    ///< [N/m] per sample of bodies: few samples bear a whole limb
inline constexpr double kWallStiffness = 150;      ///< [N/m] where one of them is a wall about something that presses
inline constexpr double kHardens = 0.001;          ///< [m] deep: the wall is met as any body
inline constexpr double kWallDamping = 0.05;       ///< [N s/m]
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

/// How two bodies press on each other where they touch.
struct Press {
  double k = kPressStiffness;  ///< [N/m]
  double d = kPressDamping;    ///< [N s/m]
  double speed = 0;            ///< that both sides have together, along the normal [m/s]

  Press part(double share) const noexcept { return {share * k, share * d, speed}; }
};
/// Nodes that swing do not tell how fast their wall goes, and go deeper in the tick than they are when it begins: what
/// they rest on would be driven by a damper that took them at their word, and by a spring that is stiff against that.
/// So where a wall rests it rests softly, and what presses it hard is met as hard as elsewhere.
/// @param swings  the sample's nodes do  @param ours, theirs  velocities of the sample and of the surface there [m/s]
inline Press press_on(const Surface& surface, bool swings, double depth, Vec3d ours, Vec3d theirs, Vec3d n) noexcept {
  Press press;
  if (swings || surface.swings) {
    const double hard = depth < kHardens ? depth / kHardens : 1;
    press.k = kWallStiffness + hard * hard * (kPressStiffness - kWallStiffness);
    press.d = kWallDamping;
  }
  if (!surface.moves()) return press;
  press.speed = swings == surface.swings ? 0.5 * dot(ours + theirs, n) : dot(swings ? theirs : ours, n);
  return press;
}

/// @param by  [m] along n
inline void press_vertex(const Surface& surface, int vertex, double by, Vec3d n, Press press,
                         NetworkLoads& loads) noexcept {
  SkinLoad load;
  load.k = press.k;
  load.shift = by * n;
  load.dir = n;
  load.d = press.d;
  load.f0 = (press.d * press.speed) * n;
  add_skin_load(surface.nodes, *surface.skin, vertex, load, {Owner::body, 0, 0}, loads);
}
/// The same on a rod. @param x0  where the point of it shall be
inline tissue::StrandLoad press_strand(int element, double w, Vec3d x0, Vec3d n, Press press) noexcept {
  tissue::StrandLoad load;
  load.element = element;
  load.w = w;
  load.k = press.k;
  load.dir = n;
  load.d = press.d;
  load.f0 = (press.d * press.speed) * n;
  load.x0 = x0;
  return load;
}

}  // namespace trocar::interactions
