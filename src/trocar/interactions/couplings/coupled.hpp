// Two material points that a law couples: the one way in which stiff couplings between bodies are integrated.
//
// Bodies advance one after the other, each in its own way, so that neither knows where the other will be. The near
// point bears the coupling implicitly, whatever its stiffness, as if the far one kept its velocity: what moves along
// together bears nothing. The far point bears the force as it is when the tick begins, and a resistance r to changes of
// its velocity. With a near point so light that it is each time where the far one was about to be a tick before, a far
// body of mass m that resists with r dt is stable from m + r dt >= k dt^2 + 2 d dt on; so [coupling-stable]
//
//   r = k dt + 2 d
//
// holds the lightest. A test finds that limit by bisection.
#pragma once

#include <trocar/interactions/bodies/bodies.hpp>
#include <trocar/interactions/bodies/material_point.hpp>

namespace trocar::interactions {

struct Coupled {
  const MaterialPoint &near, &far;
  Vec3d x, v;       ///< of the near point [m], [m/s]
  Vec3d at, moves;  ///< of the far one
  Vec3d apart;      ///< x - at

  Coupled(const Bodies& bodies, const MaterialPoint& n, const MaterialPoint& f) noexcept;
};

struct SpringDamper {
  double k = 0, d = 0;   ///< [N/m], [N s/m]
  Vec3d drawn{0, 0, 0};  ///< pull of the near on the far in the drawn shape, which both bear already [N] ...
  double whole = 1;      ///< ... of which so much is left
};

/// What a far end resists changes of its velocity with [N s/m].
constexpr double resistance_of(double k, double d, double dt) noexcept { return k * dt + 2 * d; }

void couple(const Bodies& bodies, const Coupled& ends, const SpringDamper& law, double dt, Tag tag) noexcept;

/// The far end's half of it, for couplings that the near body itself solves: a pull on it, and what it resists changes
/// of its velocity with [N s/m].
void bear(const Bodies& bodies, const MaterialPoint& far, Vec3d pull, double resists, Tag tag) noexcept;

/// A rod's end that grows out of a body gives it the rod's pull. That was found for a body that flies on freely; where
/// the tick bends that flight, the pull falls by the tangent: over one tick a resistance of so much times dt.
void end_load(const Bodies& bodies, const Attachment& on, const tissue::StrandReaction& reaction, double dt) noexcept;

}  // namespace trocar::interactions
