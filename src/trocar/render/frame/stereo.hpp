// Two eyes: from one frame the frames of both, and how their pictures are put together on a screen.
//
//   const StereoPair pair = both_eyes(frame, {.base = 0.004f, .convergence = 0.08f});
//   draw_frame(backend, pair.left, target), backend.keep_eye(Eye::left, target);
//   draw_frame(backend, pair.right, target), backend.keep_eye(Eye::right, target);
//   backend.combine(StereoMode::side_by_side, target);
//
// Both eyes look the same way; their frusta are off-axis, so that what is as far away as `convergence` is at the same
// place in both pictures: on the screen. What is nearer comes out of it. A point at distance z is apart in the two
// pictures by base (1/convergence - 1/z), as a tangent.
#pragma once

#include <trocar/render/frame/frame.hpp>

namespace trocar::render {

enum class Eye { left, right };

enum class StereoMode {
  side_by_side,    ///< left eye's picture left, each squeezed to half the width
  top_bottom,      ///< left eye's picture on top, each squeezed to half the height
  row_interlaced,  ///< rows in turn, the left eye's first, counted from the target's top: polarised screens
  anaglyph,        ///< red for the left eye, cyan for the right, colours as near as can be [Dubois 2001]
  quad_buffer,     ///< the window's own left and right buffers: shutter glasses
};

struct StereoEyes {
  float base = 0.004f;         ///< from one eye to the other [m]; stereo endoscopes: 3 to 5 mm
  float convergence = 0.080f;  ///< distance that lies on the screen [m]
};

struct StereoPair {
  Frame left, right;
};
/// The lamp stays where it is; the right eye is exposed as the left one is metered.
StereoPair both_eyes(const Frame& middle, const StereoEyes& eyes);

}  // namespace trocar::render
