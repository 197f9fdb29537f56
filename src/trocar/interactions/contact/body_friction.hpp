// Friction between bodies, and between bodies and walls: Coulomb's law, regularised. Where two surfaces are pressed
// together by N and slide past each other with speed u, each is held back by
//
//   mu N u / max(u, u0)
//
// as a dashpot that is taken implicitly with the other loads, so that it only takes energy. N is what the contact's
// spring presses with in this tick: nothing is remembered. That is its limit, too: below the angle of friction things
// do not stick but creep, with a speed of at most u0. One coefficient serves all pairs, static and sliding alike: wet
// tissue on tissue has 0.01 to 0.1 in the literature, and 0.05 is our choice.
#pragma once

#include <trocar/interactions/bodies/loads.hpp>
#include <trocar/interactions/bodies/surface.hpp>

namespace trocar::interactions {

inline constexpr double kBodyFriction = 0.05;  ///< mu [-]
inline constexpr double kCreep = 0.0005;       ///< u0 [m/s]
inline constexpr float kLeastRubbed = 0.05f;   ///< share of a contact below which a node feels no friction

/// The dashpot of one contact. `damping` 0: there is none.
struct BodyRub {
  Vec3d dir{0, 0, 0};    ///< unit, across the normal, the way the first slides on the second
  Vec3d aside{0, 0, 0};  ///< across both, where creep is so slow that its direction changes within a tick; else zero
  double damping = 0;    ///< [N s/m]

  BodyRub part(double share) const noexcept { return {dir, aside, share * damping}; }
};

/// @param press          what the contact presses with [N]
/// @param normal         unit
/// @param first, second  velocities of the two surfaces where they touch [m/s]
BodyRub body_rub(double press, Vec3d normal, Vec3d first, Vec3d second) noexcept;

/// Holds a skin vertex back against what it rubs on.
/// @param against  velocity of that [m/s]
void rub_skin(const Surface& surface, int vertex, const BodyRub& rub, Vec3d against, NetworkLoads& loads) noexcept;

/// The same for a point of a strand.
void rub_strand(int element, double w, const BodyRub& rub, Vec3d against, StrandLoads& loads) noexcept;

}  // namespace trocar::interactions
