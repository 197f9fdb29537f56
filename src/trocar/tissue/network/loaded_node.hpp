// Scratch of loads taken implicitly: what the loads of one node add up to. Filled and read by network_loads.cpp.
#pragma once

#include <cstdint>

#include <trocar/numerics/vec3.hpp>

namespace trocar::tissue {

/// Symmetric 3x3.
struct Matrix6 {
  double xx, yy, zz, xy, xz, yz;
};

/// A node that carries loads [first, last) during one tick. Most are plain: free, and their loads pull alike in all
/// directions; then the matrices are multiples of 1, of which only xx is set.
struct LoadedNode {
  int row, first, last;
  std::uint8_t held;  ///< Held bits
  bool plain;
  double mass;        ///< m (1 + dt gamma) [kg]
  Vec3d impulse;      ///< dt (f0 + K (x0 + t u)), t when the sub-step ends [N s]
  Vec3d drift;        ///< by so much it grows from one sub-step to the next: dt^2 K u [N s]
  Vec3d places;       ///< sum over sub-steps [m]
  Vec3d velocities;   ///< the same [m/s]
  Matrix6 inverse;    ///< of mass + dt D + dt^2 K on the axes that are free [1/kg]
  Matrix6 stiffness;  ///< dt K [N s/m]
  Matrix6 coupling;   ///< of held axes with the others [kg]
};

}  // namespace trocar::tissue
