#include <cmath>

#include <trocar/render/frame/frame.hpp>

namespace trocar::render {

namespace {

float srgb_to_linear(float value) {
  const float c = value / 255.0f;
  return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}

/// v turned by `angle` about the unit axis (Rodrigues).
Vec3f turned(Vec3f v, Vec3f axis, float angle) {
  const float c = std::cos(angle), s = std::sin(angle);
  return c * v + s * cross(axis, v) + (1 - c) * dot(axis, v) * axis;
}

}  // namespace

Vec3f srgb(float r, float g, float b) { return {srgb_to_linear(r), srgb_to_linear(g), srgb_to_linear(b)}; }

Camera look_at(Vec3f eye, Vec3f target, Vec3f up) {
  const Vec3f backward = normalised(eye - target, Vec3f{0, 0, 1});
  const Vec3f right = normalised(cross(up, backward), any_perpendicular(backward));
  Camera camera;
  camera.position = eye;
  camera.rotation = Mat3f::from_columns(right, cross(backward, right), backward);
  return camera;
}

Camera at_scope_tip(Vec3f tip, const Mat3f& shaft, float scope_angle, float roll) {
  const Vec3f axis = shaft.column(2);
  const Vec3f lens_right = turned(shaft.column(0), axis, roll);
  const Vec3f backward = turned(axis, lens_right, scope_angle);
  // The camera head, not the lens, says what is up in the picture.
  const Vec3f right = normalised(cross(shaft.column(1), backward), shaft.column(0));
  Camera camera;
  camera.position = tip;
  camera.rotation = Mat3f::from_columns(right, cross(backward, right), backward);
  return camera;
}

EndoscopeLook plain_look() {
  EndoscopeLook look;
  look.mask = false;
  look.notch = look.barrel = look.fringe_px = look.vignette = 0;
  look.auto_exposure = false;
  look.exposure_ev = 1;
  look.bloom = look.sharpen = look.noise = look.aperture = look.contact = 0;
  return look;
}

}  // namespace trocar::render
