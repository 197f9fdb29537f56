#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/pictures/camera_choice.hpp>

namespace trocar::pictures {
namespace {

constexpr double kDegree = portable::pi / 180;
constexpr double kNearest_mm = 30, kFarthest_mm = 1500;

CameraChoice outside(double yaw_deg, double pitch_deg, double distance_mm) {
  return {false, yaw_deg * kDegree, pitch_deg * kDegree, distance_mm * 1e-3};
}

}  // namespace

CameraChoice choice_of(const CameraPreset& p) { return outside(p.yaw_deg, p.pitch_deg, p.distance_mm); }

CameraChoice parse_camera(const std::string& text) {
  if (text == "endoscope") return {};
  for (const CameraPreset& preset : kCameraPresets)
    if (text == preset.name) return choice_of(preset);
  double yaw = 0, pitch = 0, distance = 0;
  char rest = 0;
  const bool read = std::sscanf(text.c_str(), "free:%lf,%lf,%lf%c", &yaw, &pitch, &distance, &rest) == 3;
  const bool good =
      std::fabs(yaw) <= 360 && std::fabs(pitch) <= 88 && distance >= kNearest_mm && distance <= kFarthest_mm;
  if (!read || !good)
    throw core::BadInput({{{"--camera", 0, 0},
                           tr("expected endoscope, front, side, above, surgeon or free:YAW,PITCH,DISTANCE "
                              "(-360..360 deg, -88..88 deg, {:.0f}..{:.0f} mm), got '{}'",
                              kNearest_mm, kFarthest_mm, text)}});
  return outside(yaw, pitch, distance);
}

view::Orbit orbit_of(const CameraChoice& choice, const view::Orbit& around) {
  view::Orbit orbit = around;
  orbit.yaw = choice.yaw;
  orbit.pitch = choice.pitch;
  orbit.distance = choice.distance;
  return orbit;
}

view::ViewOptions view_of(const view::Orbit& orbit) {
  view::ViewOptions options;
  options.camera = view::ViewOptions::Camera::outside;
  options.eye = orbit.eye();
  options.target = orbit.target;
  options.up = {0, 0, 1};
  return options;
}

view::ViewOptions view_of(const CameraChoice& choice, const view::Orbit& around) {
  return choice.endoscope ? view::ViewOptions{} : view_of(orbit_of(choice, around));
}

}  // namespace trocar::pictures
