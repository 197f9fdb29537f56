// --camera: through the endoscope as recorded, or from outside.
//
//   CameraChoice camera = parse_camera("free:120,30,250");
//   const view::ViewOptions options = view_of(camera, view::orbit_around(model));
#pragma once

#include <string>

#include <trocar/view/base/cameras.hpp>
#include <trocar/view/scene/scene_view.hpp>

namespace trocar::pictures {

/// Where a picture of a recording is taken from.
struct CameraChoice {
  bool endoscope = true;
  double yaw = 0, pitch = 0;  ///< [rad] as view::Orbit counts them
  double distance = 0;        ///< [m]
};

struct CameraPreset {
  const char* name;
  const char* meaning;
  double yaw_deg, pitch_deg, distance_mm;
};
inline constexpr CameraPreset kCameraPresets[] = {
    {"front", "from the feet", 0, 58, 340},
    {"side", "from the patient's left", 90, 32, 360},
    {"above", "from over the patient", 0, 88, 360},
    {"surgeon", "from where a surgeon stands, at the patient's left shoulder", 150, 45, 380},
};

/// endoscope | front | side | above | surgeon | free:YAW,PITCH,DISTANCE in degrees and mm.
/// @throws core::BadInput naming what was expected
CameraChoice parse_camera(const std::string& text);
CameraChoice choice_of(const CameraPreset& preset);

/// `around` gives the point that an outside camera looks at.
view::Orbit orbit_of(const CameraChoice& choice, const view::Orbit& around);
view::ViewOptions view_of(const view::Orbit& orbit);
view::ViewOptions view_of(const CameraChoice& choice, const view::Orbit& around);

}  // namespace trocar::pictures
