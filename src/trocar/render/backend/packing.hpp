// What the shaders are given as rows of numbers, and where on its target a picture lies.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <trocar/render/backend/backend.hpp>

namespace trocar::render {

/// Rows of u_material in surface.frag.
std::array<float, 14 * 4> packed(const Material& m);

/// Rows of u_frame in common.glsl.
std::array<float, 8 * 4> packed(const Frame& frame);

/// Where the view's circle lies and how large the scene picture is, in pixels of the target.
struct Layout {
  float centre_x, centre_y;
  float radius;          ///< of the mask's circle; without a mask half the diagonal
  int box_w, box_h;      ///< the part of the target that the scene is drawn for, around the centre
  int scene_w, scene_h;  ///< texels of the scene picture

  Layout(const Target& target, const EndoscopeLook& look, float scale) {
    centre_x = float(target.x) + 0.5f * float(target.width);
    centre_y = float(target.y) + 0.5f * float(target.height);
    box_w = target.width;
    box_h = target.height;
    if (look.mask) {
      radius = 0.5f * look.mask_diameter * float(target.height);
      const int side = int(std::ceil(2 * radius));
      box_w = std::max(1, std::min(box_w, side));
      box_h = std::max(1, std::min(box_h, side));
    } else {
      radius = 0.5f * std::sqrt(float(box_w) * float(box_w) + float(box_h) * float(box_h));
    }
    scene_w = std::max(1, int(scale * float(box_w) + 0.5f));
    scene_h = std::max(1, int(scale * float(box_h) + 0.5f));
  }
};

}  // namespace trocar::render
