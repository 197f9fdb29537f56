// A camera that goes around a point, for what stands alone: a room, a mechanism.
#pragma once

#include <trocar/numerics/vec3.hpp>

namespace trocar::view {

/// From around a point; up is up.
struct UprightOrbit {
  Vec3d target{0, 0.05, -0.05};
  double yaw = -0.75, pitch = 0.55, distance = 2.9;
  Vec3d eye() const;
  void turn(double by_yaw, double by_pitch);
  void pan(double right, double up);
  void zoom(double factor);
};

}  // namespace trocar::view
