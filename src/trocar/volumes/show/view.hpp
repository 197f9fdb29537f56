// From where a volume is looked at, and the picture that comes of it. In the frame of scenes: metres, x to the
// patient's left, y to the head, z to the front.
#pragma once

#include <cstdint>
#include <vector>

#include <trocar/numerics/vec3.hpp>

namespace trocar::volumes {

struct View {
  Vec3d eye{0, 0, 1}, target{}, up{0, 1, 0};  ///< [m]
  double fov_deg = 30;                        ///< of the picture's height; 0: parallel rays
  double height_m = 0.4;                      ///< of the picture, at parallel rays
  int width = 640, height = 480;
};

/// Rows from the top, four bytes a pixel: red, green, blue, opacity, the colours multiplied by the opacity.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
  /// Along each ray to where half of the light is stopped [mm from the eye, or from the eye's plane]; infinite where it
  /// is not. Only of pictures of volumes.
  std::vector<float> depth;

  const std::uint8_t* at(int x, int y) const {
    return rgba.data() + 4 * (std::size_t(y) * std::size_t(width) + std::size_t(x));
  }
};

}  // namespace trocar::volumes
