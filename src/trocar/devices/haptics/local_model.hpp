// What a hand feels between two ticks of the simulation: up to three planes that hold an instrument's point back, the
// tissue that it holds, and the friction of its trocar's seal. Plain bytes: the simulation makes one in every tick, the
// loop of the device (haptic_loop.hpp) takes the newest, at its own rate.
//
// The god object [Zilles & Salisbury 1995] is the place nearest to the instrument's point p that the planes allow,
// the x of least |x - p|^2 with n_i . x >= n_i . q_i; what pushes is a spring from p to x.
#pragma once

#include <cstdint>
#include <span>

#include <trocar/numerics/vec3.hpp>

namespace trocar::devices {

inline constexpr int kMostPlanes = 3;

struct ContactPlane {
  Vec3d point;   ///< on it [m]
  Vec3d normal;  ///< unit, to where the instrument may be
};

/// The place nearest to p on the free side of all planes. Where they leave no room, the nearest to the first of them
/// that can be satisfied together.
/// @param planes  at most kMostPlanes
Vec3d nearest_allowed(Vec3d p, std::span<const ContactPlane> planes) noexcept;

/// Places of the device in space: place = centre + scale * axes * (device - middle).
struct HandFrame {
  Mat3d axes = Mat3d::identity();  ///< columns: where the device's right, forward and up point
  Vec3d centre;                    ///< [m]
  Vec3d middle;                    ///< of the device, that is there [m]
  double scale = 1;

  Vec3d to_space(Vec3d device) const { return centre + scale * (axes * (device - middle)); }
  Vec3d to_device(Vec3d space) const { return middle + (transposed(axes) * (space - centre)) / scale; }
  /// The device's force that does the same work as `force` does in space [N].
  Vec3d force_on_device(Vec3d force) const { return scale * (transposed(axes) * force); }
};

struct LocalModel {
  std::uint64_t tick = 0;
  HandFrame frame;
  ContactPlane plane[kMostPlanes];
  std::int32_t planes = 0;
  std::int32_t holds = 0;     ///< 1: tissue is held, which pulls both ways
  double stiffness = 0;       ///< of planes [N/m]
  double damping = 0;         ///< across planes, while they are touched [N s/m]
  double rubbing = 0;         ///< Coulomb's coefficient along planes
  Vec3d held_at;              ///< where the held tissue wants the point to be [m]
  double held_stiffness = 0;  ///< [N/m]
  Vec3d port;                 ///< of the trocar [m]
  double seal_friction = 0;   ///< along the shaft [N]
};

}  // namespace trocar::devices
