// What a picture shows where, without its light: depth, normals, part numbers and motion, for those who teach machines
// to see. In the same pixels as the picture: with the lens's barrel, and nothing outside its circle.
//
//   const Layers now = backend.draw_layers(frame, frame.camera, 800, 600);
//   backend.remember(frame);                                    // ... meshes move, the camera turns ...
//   const Layers then = backend.draw_layers(next, frame.camera, 800, 600);   // with flow
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <trocar/render/frame/frame.hpp>

namespace trocar::render {

/// Rows from the top. Where nothing is seen: part 0, the rest not a number.
struct Layers {
  int width = 0, height = 0;
  std::vector<float> depth;                  ///< (width height) along the optical axis [m]
  std::vector<std::array<float, 3>> normal;  ///< (width height) unit; x right, y down, z away from the camera
  std::vector<std::uint16_t> part;           ///< (width height) DrawItem::part, Liquid::part
  /// (width height) [px] right and down from here to where the same point of the same thing was in the remembered
  /// frame's picture, seen or not; not a number where nothing is known of it: new things, liquids, a mesh made again.
  std::vector<std::array<float, 2>> flow;

  static Layers nothing(int width, int height);
};

/// How the picture of a camera comes about, in pixels with whole numbers in their middles, from the top left: a point
/// (x, y, z) in the camera's frame (right, down, forward) falls on u = (x/z - shift) focal, v = y/z focal from the
/// centre, and the lens shows that where p (1 + barrel p^2/radius^2) / (1 + barrel) = (u, v), p from the centre, too.
struct Projection {
  float centre_x = 0, centre_y = 0;
  float focal = 1;   ///< [px]
  float shift = 0;   ///< Camera::shift
  float barrel = 0;  ///< EndoscopeLook::barrel
  float radius = 1;  ///< [px] of the view's circle, half the diagonal without one
  bool circle = false;

  Projection(const Camera& camera, const EndoscopeLook& look, int width, int height);

  /// Both from the centre [px].
  std::array<float, 2> straightened(float x, float y) const;
  std::array<float, 2> bent(float u, float v) const;
  /// Of a point in the camera's frame (x right, y up, z towards the viewer), from the centre, y down [px].
  /// Not a number behind the lens.
  std::array<float, 2> seen_at(Vec3f eye) const;
};

/// What the scene pass leaves of each texel; eye frames are x right, y up, z towards the viewer.
struct RawLayers {
  int width = 0, height = 0;   ///< of the scene picture, rows from the bottom
  std::vector<float> surface;  ///< (width height 4): unit normal, and part + 1; negative: no place before; 0: nothing
  std::vector<float> places;   ///< (width height 4): depth [m], place before in the eye's frame then [m]
};
/// Through the lens: each pixel takes the texel that it shows.
/// @param before  of the remembered picture
Layers through_lens(const RawLayers& raw, const Projection& now, const Projection& before, int width, int height);

}  // namespace trocar::render
