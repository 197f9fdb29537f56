#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/view/base/cameras.hpp>

namespace trocar::view {

using render::Camera;
using render::EndoscopeLook;
using render::Light;

Camera scope_camera(const kinematics::ScopeFrame& scope, double field_of_view) {
  Camera camera;
  camera.position = vec_cast<float>(scope.eye);
  camera.rotation =
      Mat3f::from_columns(vec_cast<float>(scope.right), vec_cast<float>(scope.up), vec_cast<float>(-scope.forward));
  camera.vertical_fov = float(field_of_view);
  camera.near_plane = 0.002f;
  camera.far_plane = 0.5f;
  return camera;
}

double notch_angle(const kinematics::ScopeFrame& scope, const kinematics::TipFrame& shaft, double post) {
  const Vec3d side = std::cos(post) * shaft.normal() + std::sin(post) * shaft.opening();
  return std::atan2(dot(side, scope.right), dot(side, scope.up));
}

Camera outside_camera(Vec3d eye, Vec3d target, Vec3d up, double field_of_view) {
  Camera camera = render::look_at(vec_cast<float>(eye), vec_cast<float>(target), vec_cast<float>(up));
  camera.vertical_fov = float(field_of_view);
  camera.near_plane = 0.01f;
  camera.far_plane = 3;
  return camera;
}

Light room_light() {
  Light light;
  light.position = {0.15f, 0.5f, 0.25f};
  light.colour = {1, 0.98f, 0.95f};
  light.inverse_square = false;
  light.intensity = 0.6f;
  light.bounce = 0.06f;
  light.bounce_colour = {1, 0.9f, 0.85f};
  light.ambient = 0.12f;
  light.crevices = 0.5f;  // baked within the cavity, whose walls are not there
  return light;
}

EndoscopeLook room_look() {
  EndoscopeLook look = render::plain_look();
  look.auto_exposure = true;
  look.exposure_key = 0.12f;
  return look;
}

namespace {

constexpr double kCameraSteepest = 1.54, kCameraNearest = 0.03, kCameraFarthest = 1.5;  // [rad], [m]

struct Box {
  Vec3d low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  void add(Vec3d p) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
};

}  // namespace

Vec3d Orbit::eye() const {
  return target + distance * Vec3d{std::sin(yaw) * std::cos(pitch), -std::cos(yaw) * std::cos(pitch), std::sin(pitch)};
}

void Orbit::turn(double by_yaw, double by_pitch) {
  yaw = std::remainder(yaw + by_yaw, 2 * portable::pi);
  pitch = std::clamp(pitch + by_pitch, -kCameraSteepest, kCameraSteepest);
}

void Orbit::pan(double right, double up) {
  const Vec3d to_right{std::cos(yaw), std::sin(yaw), 0}, backward = (eye() - target) / distance;
  target += right * to_right + up * cross(backward, to_right);
}

void Orbit::zoom(double factor) { distance = std::clamp(distance * factor, kCameraNearest, kCameraFarthest); }

Orbit orbit_around(const sim::Model& model) {
  Box box;
  for (const interactions::StrandBody& strand : model.strand_bodies)
    for (Vec3d p : strand.model.rest) box.add(p);
  for (int i = 0; model.strand_bodies.empty() && i < model.organs(); ++i)
    for (int v = 0; v < model.skin(i).size(); ++v)
      if (model.skin(i).at_surface(v)) box.add(vec_cast<double>(model.skin(i).rest[std::size_t(v)]));
  Orbit orbit;
  if (box.low.x <= box.high.x) orbit.target = 0.5 * (box.low + box.high);
  return orbit;
}

}  // namespace trocar::view
