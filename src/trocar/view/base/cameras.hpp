// Where a picture is taken from, and what lights it: through the endoscope, or from outside.
#pragma once

#include <trocar/kinematics/fulcrum.hpp>
#include <trocar/render/frame/frame.hpp>
#include <trocar/sim/model/model.hpp>

namespace trocar::view {

/// Camera at the scope's tip. The circle of the mask, one picture height wide, holds the cone `field_of_view` [rad].
render::Camera scope_camera(const kinematics::ScopeFrame& scope, double field_of_view);
/// The notch on the mask's rim stands where the light post is [rad, clockwise from 12 o'clock].
/// @param shaft without roll; @param post the light post's turn [rad]
double notch_angle(const kinematics::ScopeFrame& scope, const kinematics::TipFrame& shaft, double post);

/// A free camera; far plane and near plane fit a scene of about half a metre.
render::Camera outside_camera(Vec3d eye, Vec3d target, Vec3d up, double field_of_view);
/// Room light for it: the same everywhere, from above the camera.
render::Light room_light();
render::EndoscopeLook room_look();

/// A free camera as hands turn it: it looks at a point from around it, the patient's front (z) always up in the
/// picture.
struct Orbit {
  Vec3d target;           ///< [m]
  double yaw = 0;         ///< [rad] 0: from the feet towards the head; pi/2: from the patient's left
  double pitch = 0.6;     ///< [rad] above the patient's plane; just short of straight up and down at most
  double distance = 0.4;  ///< [m] 0.03 .. 1.5

  Vec3d eye() const;
  void turn(double by_yaw, double by_pitch);  ///< [rad]
  void pan(double right, double up);          ///< [m] of the target, along the picture
  void zoom(double factor);                   ///< of the distance

  friend bool operator==(const Orbit& a, const Orbit& b) {
    return length(a.target - b.target) == 0 && a.yaw == b.yaw && a.pitch == b.pitch && a.distance == b.distance;
  }
};

/// Looks at the middle of what a scene's strands and organs are, from the feet and above.
Orbit orbit_around(const sim::Model& model);

}  // namespace trocar::view
