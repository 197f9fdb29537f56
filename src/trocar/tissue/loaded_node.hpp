// Scratch of loads taken implicitly: what the loads of one node add up to. Filled and read by network_loads.cpp.
#pragma once

#include <cstdint>

#include <trocar/numerics/vec3.hpp>

namespace trocar::tissue {

/// Symmetric 3x3.
struct Matrix6 {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
};

/// A node that carries loads [first, last) during one tick.
struct LoadedNode {
  int row = 0, first = 0, last = 0;
  int held = 0;       ///< Held bits
  double mass = 0;    ///< m (1 + dt gamma) [kg]
  Matrix6 inverse;    ///< of mass + dt D + dt^2 K on the axes that are free [1/kg]
  Matrix6 stiffness;  ///< dt K [N s/m]
  Matrix6 coupling;   ///< of held axes with the others [kg]
  Vec3d impulse;      ///< dt (f0 + K x0) [N s]
  Vec3d places;       ///< sum over sub-steps [m]
  Vec3d velocities;   ///< the same [m/s]
};

}  // namespace trocar::tissue
