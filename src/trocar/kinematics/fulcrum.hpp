// An instrument through a trocar: four degrees of freedom about a fixed point (the fulcrum).
//   R = Rot_y(yaw) Rot_x(pitch) Rot_z(roll),  axis = R (0,0,-1),  tip = port + depth * axis
// so that at zero angles the shaft points to the patient's back. Jaws open along R (1,0,0).
#pragma once

#include <trocar/core/fields.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::kinematics {

struct FulcrumPose {
  double yaw = 0, pitch = 0, roll = 0;  ///< [rad]
  double depth = 0;                     ///< port to tip along the shaft [m]
};

/// Position and orientation of the tip. Columns of `rotation`: opening direction, jaw-plane normal, minus the axis.
struct TipFrame {
  Vec3d tip;
  Mat3d rotation = Mat3d::identity();

  Vec3d axis() const { return -rotation.column(2); }
  Vec3d opening() const { return rotation.column(0); }
  Vec3d normal() const { return rotation.column(1); }
};

/// What a trocar and a hand allow.  Figures: our choice, see docs/reference/scene_format.md
struct FulcrumLimits {
  double angle = 1.45;                          ///< yaw and pitch, [rad]
  double depth_min = 0.005, depth_max = 0.290;  ///< [m]
  double roll = portable::two_pi;               ///< [rad]

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("angle", s.angle), v("depth_min", s.depth_min), v("depth_max", s.depth_max), v("roll", s.roll);
  }
};

/// Forward kinematics.
TipFrame forward(Vec3d port, const FulcrumPose& pose) noexcept;

/// Inverse kinematics: the pose whose tip is `tip`, keeping `roll`. Exact: forward(inverse(tip)) == tip to 1e-9 m.
/// A tip at the port itself gives depth 0 and zero angles.
FulcrumPose inverse(Vec3d port, Vec3d tip, double roll) noexcept;

/// The roll that turns the jaw-plane normal as near as possible to `direction` for the shaft axis of `pose`.
double roll_towards(const FulcrumPose& pose, Vec3d direction) noexcept;

/// Nearest pose within the limits.
FulcrumPose clamped(const FulcrumPose& pose, const FulcrumLimits& limits) noexcept;

/// View direction of an oblique scope: the shaft's axis turned by `angle` about the axis that `post_roll` selects.
/// `head_roll` turns the picture (camera head), `post_roll` the light post, independent of each other.
struct ScopeFrame {
  Vec3d eye, forward, up, right;
};
ScopeFrame scope_frame(Vec3d port, const FulcrumPose& pose, double angle, double post_roll) noexcept;

}  // namespace trocar::kinematics
