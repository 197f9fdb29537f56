#include <algorithm>

#include <trocar/kinematics/fulcrum.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::kinematics {
namespace {

Mat3d rotation_yx(double yaw, double pitch) noexcept {
  const double cy = portable::cos(yaw), sy = portable::sin(yaw);
  const double cp = portable::cos(pitch), sp = portable::sin(pitch);
  return {{{cy, sy * sp, sy * cp}, {0, cp, -sp}, {-sy, cy * sp, cy * cp}}};
}

Mat3d rotation_z(double roll) noexcept {
  const double c = portable::cos(roll), s = portable::sin(roll);
  return {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
}

}  // namespace

TipFrame forward(Vec3d port, const FulcrumPose& pose) noexcept {
  TipFrame frame;
  frame.rotation = rotation_yx(pose.yaw, pose.pitch) * rotation_z(pose.roll);
  frame.tip = port + pose.depth * frame.axis();
  return frame;
}

FulcrumPose inverse(Vec3d port, Vec3d tip, double roll) noexcept {
  const Vec3d shaft = tip - port;
  FulcrumPose pose;
  pose.roll = roll;
  pose.depth = length(shaft);
  if (pose.depth < 1e-12) return {0, 0, roll, 0};
  // axis = R (0,0,-1) = (-sin yaw cos pitch, sin pitch, -cos yaw cos pitch)
  const Vec3d a = shaft / pose.depth;
  const double cos_pitch = std::sqrt(a.x * a.x + a.z * a.z);
  pose.pitch = portable::atan2(a.y, cos_pitch);
  pose.yaw = cos_pitch > 1e-12 ? portable::atan2(-a.x, -a.z) : 0.0;
  return pose;
}

double roll_towards(const FulcrumPose& pose, Vec3d direction) noexcept {
  // The jaw-plane normal is R_yx (-sin roll, cos roll, 0): the best roll is the angle of the direction's projection.
  const Mat3d r = rotation_yx(pose.yaw, pose.pitch);
  const double along_x = dot(r.column(0), direction), along_y = dot(r.column(1), direction);
  return portable::atan2(-along_x, along_y);
}

FulcrumPose clamped(const FulcrumPose& pose, const FulcrumLimits& limits) noexcept {
  FulcrumPose p = pose;
  p.yaw = std::clamp(p.yaw, -limits.angle, limits.angle);
  p.pitch = std::clamp(p.pitch, -limits.angle, limits.angle);
  p.roll = std::clamp(p.roll, -limits.roll, limits.roll);
  p.depth = std::clamp(p.depth, limits.depth_min, limits.depth_max);
  return p;
}

ScopeFrame scope_frame(Vec3d port, const FulcrumPose& pose, double angle, double post_roll) noexcept {
  FulcrumPose shaft = pose;
  shaft.roll = 0;
  const TipFrame tip = forward(port, shaft);
  // The oblique lens looks off the axis towards the side that the light post selects.
  const double c = portable::cos(post_roll), s = portable::sin(post_roll);
  const Vec3d side = c * tip.normal() + s * tip.opening();
  const double ca = portable::cos(angle), sa = portable::sin(angle);
  ScopeFrame frame;
  frame.eye = tip.tip;
  frame.forward = ca * tip.axis() + sa * side;
  // The camera head keeps the horizon: up is the patient's front as far as the view allows, then turned by the head.
  const Vec3d front{0, 0, 1};
  const Vec3d upright = front - dot(front, frame.forward) * frame.forward;
  const Vec3d beside = tip.normal() - dot(tip.normal(), frame.forward) * frame.forward;
  const Vec3d up0 = normalised(length(upright) > 0.02 ? upright : beside);
  const Vec3d right0 = cross(frame.forward, up0);
  const double ch = portable::cos(pose.roll), sh = portable::sin(pose.roll);
  frame.up = ch * up0 + sh * right0;
  frame.right = cross(frame.forward, frame.up);
  return frame;
}

}  // namespace trocar::kinematics
