// Pictures for two eyes: what a person chose, and how a frame is drawn so.
//
//   const TwoEyes eyes = parse_stereo("side-by-side:4,80");   // [mm] between the eyes, to what lies on the screen
//   draw_for(eyes, backend, frame, target);
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <trocar/render/backend/backend.hpp>

namespace trocar::pictures {

struct TwoEyes {
  std::optional<render::StereoMode> mode;  ///< none: one eye
  render::StereoEyes eyes;
  bool swapped = false;  ///< the left eye's picture goes to the right eye

  bool on() const { return mode.has_value(); }
};

struct StereoName {
  const char* name;
  const char* meaning;
  std::optional<render::StereoMode> mode;
};
inline constexpr StereoName kStereoNames[] = {
    {"off", "one eye", {}},
    {"side-by-side", "side by side, squeezed", render::StereoMode::side_by_side},
    {"top-bottom", "top and bottom, squeezed", render::StereoMode::top_bottom},
    {"rows", "rows in turn: polarised screens", render::StereoMode::row_interlaced},
    {"anaglyph", "red and cyan glasses", render::StereoMode::anaglyph},
    {"quad-buffer", "shutter glasses; after a new start", render::StereoMode::quad_buffer},
};
inline constexpr double kLeastBase = 0.5, kMostBase = 12, kLeastConvergence = 20, kMostConvergence = 500;  ///< [mm]

inline constexpr const char* kStereoHelp =
    "of pictures and film: off | side-by-side | top-bottom | rows | anaglyph, with :BASE,CONVERGENCE [mm] if wanted";
inline std::vector<std::string> stereo_names() {
  std::vector<std::string> names;
  for (const StereoName& s : kStereoNames) names.push_back(s.name);
  return names;
}

/// MODE or MODE:BASE,CONVERGENCE, for pictures in files: no quad buffers.  @throws core::BadInput naming what was
/// expected
TwoEyes parse_stereo(const std::string& text);

/// Both frames for the chosen eyes; what goes to the left eye first.
render::StereoPair eyes_of(const TwoEyes& eyes, const render::Frame& frame);
/// One picture, or both put together.
void draw_for(const TwoEyes& eyes, render::Backend& backend, const render::Frame& frame, const render::Target& target);

}  // namespace trocar::pictures
