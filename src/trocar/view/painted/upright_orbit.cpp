#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/view/painted/upright_orbit.hpp>

namespace trocar::view {
namespace {

constexpr double kOrbitNearest = 0.12, kOrbitFarthest = 6, kOrbitSteepest = 1.5;  // of the orbit

}  // namespace

Vec3d UprightOrbit::eye() const {
  return target + distance * Vec3d{std::sin(yaw) * std::cos(pitch), -std::cos(yaw) * std::cos(pitch), std::sin(pitch)};
}
void UprightOrbit::turn(double by_yaw, double by_pitch) {
  yaw = std::remainder(yaw + by_yaw, portable::two_pi);
  pitch = std::clamp(pitch + by_pitch, -0.15, kOrbitSteepest);
}
void UprightOrbit::pan(double right, double up) {
  const Vec3d to_right{std::cos(yaw), std::sin(yaw), 0}, backward = (eye() - target) / distance;
  target += right * to_right + up * cross(backward, to_right);
}
void UprightOrbit::zoom(double factor) { distance = std::clamp(distance * factor, kOrbitNearest, kOrbitFarthest); }

}  // namespace trocar::view
