#include <trocar/render/frame/stereo.hpp>

namespace trocar::render {
namespace {

/// @param aside  [m] to the right
Frame seen_from(const Frame& middle, float aside, float convergence) {
  Frame frame = middle;
  frame.camera.position += aside * middle.camera.rotation.column(0);
  frame.camera.shift = middle.camera.shift - aside / convergence;
  frame.light.position.x -= aside;
  return frame;
}

}  // namespace

StereoPair both_eyes(const Frame& middle, const StereoEyes& eyes) {
  StereoPair pair{seen_from(middle, -0.5f * eyes.base, eyes.convergence),
                  seen_from(middle, 0.5f * eyes.base, eyes.convergence)};
  pair.right.metering = false;
  return pair;
}

}  // namespace trocar::render
