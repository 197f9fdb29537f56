// One picture to draw: where the camera is, what lights the scene, what is in it, and what the optics do to it.
// Plain data, made again each frame by view.
//
//   Frame frame;
//   frame.camera = look_at(scope_tip, target, up);
//   frame.tick = now;                                  // [ms] simulated time; noise and exposure follow it, no clock
//   frame.items.push_back({.mesh = pear, .material = liver});
//   draw_frame(backend, frame, Target::off_screen(800, 600));
#pragma once

#include <cstdint>
#include <vector>

#include <trocar/numerics/vec3.hpp>
#include <trocar/render/frame/liquid.hpp>
#include <trocar/render/frame/mat4.hpp>
#include <trocar/render/frame/material.hpp>
#include <trocar/render/frame/mesh_data.hpp>

namespace trocar::render {

/// Looks along minus the third column of `rotation` (columns: right, up, backward; a right-handed unit frame).
struct Camera {
  Vec3f position;
  Mat3f rotation = Mat3f::identity();
  float vertical_fov = 1.05f;  ///< [rad] of the whole picture height
  float near_plane = 0.003f;   ///< [m]
  float far_plane = 0.6f;      ///< [m]
  float shift = 0;  ///< tangent of how far to the right the picture's middle looks: an off-axis frustum (stereo.hpp)
};
/// A camera at `eye` looking at `target`, the picture's top as near to `up` as can be.
Camera look_at(Vec3f eye, Vec3f target, Vec3f up);
/// A camera at the tip of a scope. @param shaft columns right, up, backward along the shaft (tip -> hand)
/// @param scope_angle [rad] 0 looks along the shaft, 30 degrees looks up from it (towards `up` rolled by `roll`)
/// @param roll [rad] turn of the scope about its shaft under a camera head that stays upright
Camera at_scope_tip(Vec3f tip, const Mat3f& shaft, float scope_angle, float roll);

/// One lamp: the ring of the scope (default) or a room lamp.
struct Light {
  Vec3f position = {0.0014f, 0.0034f, 0.0006f};  ///< [m] in the camera's frame: the fibres' crescent, off the lens
  float ring = 0.004f;                           ///< radius of the luminous area [m]: how soft shadows are
  Vec3f colour = {1.0f, 0.97f, 0.98f};
  float intensity = 0.45f;           ///< irradiance at reference_distance; 1 shows white as white
  float reference_distance = 0.06f;  ///< [m]
  bool inverse_square = true;        ///< false: the same everywhere (operating room, analysis views)
  float bounce = 0.035f;             ///< light that the walls return, as a share
  Vec3f bounce_colour = {1.0f, 0.31f, 0.37f};
  float ambient = 0;   ///< white light from everywhere (0 inside a body)
  float crevices = 1;  ///< how much of Paint::openness shows (0 where shades would be taken for figures)
};

struct EndoscopeLook {
  // Lens.
  bool mask = true;            ///< black outside a circle
  float mask_diameter = 1.0f;  ///< in picture heights
  float mask_soft_px = 3;      ///< width of its edge [px of the target]
  float notch = 1;             ///< 0 none .. 1: small orientation notch on the rim
  float notch_angle = 0;       ///< [rad] clockwise from 12 o'clock (turns with the scope)
  float barrel = 0.10f;        ///< how much less the rim is magnified than the centre
  float fringe_px = 1.0f;      ///< chromatic shift at the rim [px of a 600 px high picture]
  float vignette = 0.6f;       ///< 0 none .. 1 = cos^4 of the field angle
  // Camera.
  bool auto_exposure = true;
  float exposure_ev = 0;          ///< [stops] on top; with auto_exposure off this is all there is
  float exposure_key = 0.133f;    ///< mean scene level that auto exposure aims at (linear)
  float exposure_seconds = 0.4f;  ///< time constant
  float exposure_range_ev = 4;    ///< limits, both ways
  float bloom = 0.05f;
  // A rod lens is focused once, for the middle distance; a point at d blurs to aperture |1/d - 1/focus|, as an angle.
  // Both figures are our choice: rigid endoscopes are at f/8 to f/12, with a camera that sees 60 degrees on a third of
  // an inch. They keep all beyond 45 mm sharp to a line of a picture of 600.
  float focus = 0.070f;       ///< [m] what is sharpest
  float aperture = 0.00032f;  ///< [m] diameter of the entrance pupil; 0: all is in focus
  float contact = 0.3f;       ///< 0 none .. 1: darkening behind the edge of nearer things
  float sharpen = 1.0f;       ///< video sharpening overshoot
  float noise = 0.00085f;     ///< sensor noise at mid grey; more in the dark
  float saturation = 1;
  Vec3f white_balance = {1, 1, 1};
  // Air.
  float fog = 0;  ///< smoke veil, extinction [1/m]
  Vec3f fog_colour = {0.62f, 0.47f, 0.37f};
  // What is on the glass.
  LensSoil soil;
};
/// A plain camera: no mask, barrel, fringe, vignette, noise, bloom, defocus, or auto exposure.
EndoscopeLook plain_look();

enum class DrawStyle : std::uint8_t {
  shaded,
  transparent,  ///< a ghost of itself: what is behind shows through
  wireframe,    ///< the edges of its triangles
};

struct DrawItem {
  MeshHandle mesh;
  Material material;
  Mat4 transform;            ///< mesh -> world; rotation, translation and uniform scale only
  bool translucent = false;  ///< drawn after the opaque ones, far to near by the middle of its bounds, both sides
  float nearer = 0;          ///< [m] translucent ones that lie in others: their place in the order, not in space
  DrawStyle style = DrawStyle::shaded;
  std::uint8_t level = 0;   ///< of its mesh: 0 all triangles, k the k-th coarser list or the last that there is
  std::uint8_t detail = 2;  ///< of its surface, at most the frame's (Quality::detail)
  std::uint16_t part = 0;   ///< what it is of, by the caller's numbers; 0: nothing that has a name

  bool blends() const { return (translucent && style == DrawStyle::shaded) || style == DrawStyle::transparent; }
};

/// A rod that takes light from what is near and behind it: an instrument's shaft or jaw, for the eye to judge how far
/// above the tissue it is. Shadows of everything else are the depth darkening's.
struct Rod {
  Vec3f from, to;         ///< [m] world
  float radius = 0.002f;  ///< [m]
  float pressed = 0;      ///< 0..1: how far it presses the blood out of tissue that it touches
};
inline constexpr int kMaxRods = 16;  ///< more are left out

/// A soft puff of smoke or mist, drawn facing the eye.
struct Puff {
  Vec3f centre;          ///< [m] world
  float radius = 0.01f;  ///< [m]
  float density = 0.2f;  ///< opacity in the middle, 0..1
};

/// What the picture may cost; see governor.hpp.
struct Quality {
  float render_scale = 1;  ///< of the scene pass, 0.25..1 (the lens pass is always at full size)
  int detail = 2;  ///< 2 everything; 1 no fine flecks, bloom, fringe, focus or contact shade, and liquids mirror the
                   ///< walls only; 0 no vessels or film ripples either

  float coarser =
      1;  ///< things get coarser at this part of their distances: 2 at half of them (view/base/level_of_detail.hpp)
  int samples = 1;  ///< a pixel of opaque things: 4 makes their outlines smooth

  friend bool operator==(Quality a, Quality b) {
    return a.render_scale == b.render_scale && a.detail == b.detail && a.samples == b.samples && a.coarser == b.coarser;
  }
};

struct Frame {
  Camera camera;
  Light light;
  EndoscopeLook look;
  Quality quality;
  std::vector<DrawItem> items;
  std::vector<Puff> puffs;
  std::vector<Rod> rods;
  Liquid liquid;
  SmokeVolume smoke;
  Vec3f background = {0.0015f, 0.0004f, 0.0003f};  ///< linear, where nothing is drawn
  std::uint64_t tick = 0;                          ///< [ms] simulated
  int eye = 0;                                     ///< 0..7: each eye or window has its own exposure memory
  bool metering = true;  ///< false: use the memory of `eye` unchanged (the second picture of a stereo pair)
};

/// Where the picture goes.
struct Target {
  static constexpr unsigned kOwnBuffer = ~0u;
  unsigned framebuffer = kOwnBuffer;  ///< GL name, 0 = the window
  int x = 0, y = 0;                   ///< lower left corner [px]
  int width = 0, height = 0;          ///< [px]

  static Target off_screen(int width, int height) { return {kOwnBuffer, 0, 0, width, height}; }
  static Target window(int width, int height) { return {0, 0, 0, width, height}; }
};

}  // namespace trocar::render
