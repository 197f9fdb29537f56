// Liquids as the renderer sees them: splats that merge into one surface (drops in flight, drops that run, films), and a
// sheet that has gathered. Plain data, made again each frame by view.
//
// Splats are drawn into three small pictures (field, thickness, film) and added up; where the field passes a threshold
// there is liquid, its thickness and normal follow from the field, and its colour from the law of Beer and Lambert:
//   C = C_bed T + C_deep L (1 - T),  T = exp(-tau),  tau = path sum_k share_k (absorbs_k + scatters_k)
// and in red T (1 - s + s exp(-path sum_k share_k orange_k)), s the share of orange in it.
// The sheet is a mesh of heights with the liquid's depth at its vertices; what lies below it is seen through it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <trocar/numerics/vec3.hpp>

namespace trocar::render {

inline constexpr int kLiquidKinds = 3;  ///< what a liquid may be mixed of

struct LiquidLook {
  struct Kind {
    Vec3f absorbs{0, 0, 0};  ///< per channel, of the undiluted kind [1/m]
    float scatters = 0;      ///< out of the straight way, all channels alike [1/m]
    Vec3f deep{0, 0, 0};     ///< what a bottomless depth of it sends back (linear)
    float cells = 0;         ///< how much of what comes back is its own, against the other kinds
    float orange = 0;        ///< absorbed besides, in the orange part of the camera's red [1/m]
  };
  std::array<Kind, kLiquidKinds> kinds{};
  float orange_share = 0.30f;    ///< of a camera's red: what lies below 600 nm (our choice)
  float fresnel = 0.021f;        ///< reflectance at normal incidence
  float drop_roughness = 0.20f;  /// of drops and the sheet, as film_roughness of a Material
  float film_roughness = 0.16f;
  float dark = 0.6f;  ///< how much darker what has clotted is: 1 - this
};

enum class SplatKind : std::uint8_t {
  flying,  ///< round, in the air
  lying,   ///< a cap on a surface
  film,    ///< a stain: no body of its own
  streak   ///< in the air, smeared by its speed: thin and faint at both ends, without a glint
};

inline constexpr float kSplatReach = 1.7f;  ///< how far a splat's field goes, in radii: as in splat.vert

/// A blob around the axis from..to.
struct Splat {
  Vec3f from, to;         ///< [m] world; equal for a ball or a round cap
  float radius = 0.001f;  ///< to its outline [m]
  float height =
      0.001f;    ///< of its middle above its plane; flying: half of its thickness; film, streak: its thickness [m]
  Vec3f normal;  ///< unit, of the surface below it; flying: not used
  std::array<float, kLiquidKinds> share{1, 0, 0};
  float dark = 0;  ///< 0 fresh .. 1 clotted
  SplatKind kind = SplatKind::flying;
  bool sheer = false;  ///< what it lies on is drawn translucent, so the picture knows no distance of it
};

/// A corner of the sheet. Its border is where `cover`, interpolated, passes one third: a smooth line, not cells.
struct SheetVertex {
  Vec3f position;                  ///< [m] world
  float depth = 0;                 ///< of the liquid below [m]
  Vec3f normal;                    ///< unit
  float cover = 0;                 ///< 0 dry .. 1 wet
  float share_b = 0, share_c = 0;  ///< of the second and third kind; the rest is the first
  float froth = 0;                 ///< 0 .. 1: bubbles
  float dark = 0;
};

struct Liquid {
  LiquidLook look;
  std::vector<Splat> splats;
  std::vector<SheetVertex> sheet;
  std::vector<std::uint32_t> triangles;  ///< of the sheet, counter-clockwise seen from above
  Vec3f down{0, 0, -1};                  ///< unit: films run that way
  std::uint16_t part = 0;                ///< as DrawItem::part

  bool empty() const { return splats.empty() && triangles.empty(); }
};

/// Smoke in a grid of cells, x fastest, lit by the lamp.
struct SmokeVolume {
  Vec3f origin;  ///< lowest corner [m] world
  float cell = 0.0125f;
  int nx = 0, ny = 0, nz = 0;
  std::vector<float> density;              ///< (nx ny nz) [g/m^3]; empty = no smoke
  float kappa = 0.7f;                      ///< extinction [m^2/g]
  Vec3f colour{0.600f, 0.585f, 0.605f};    ///< linear; red walls light it, too
  Vec3f near_colour{0.62f, 0.50f, 0.43f};  ///< of what the lamp lights from close by
  float rise = 0.05f;                      ///< how fast its curls go up [m/s]
  Vec3f up{0, 0, 1};
  bool empty() const { return density.empty(); }
};

/// A drop on the lens, out of focus. Lengths in radii of the view; x right, y up from its middle.
struct LensDrop {
  float x = 0, y = 0, radius = 0.1f;
  Vec3f tint{1, 1, 1};  ///< what it lets through
};

/// What is on the lens.
struct LensSoil {
  static constexpr int kMaxDrops = 8;
  float fog = 0;          ///< 0 clear .. 1: blurred over 12 px of a 600 px high picture, blacks lifted
  float smear = 0;        ///< 0 .. 1: a greasy veil in streaks
  float smear_angle = 0;  ///< [rad] of the streaks, 0 = along x
  Vec3f smear_tint{1, 1, 1};
  float wipe = -1;  ///< < 0 none; 0 .. 1: how far the swab has passed across
  Vec3f swab{0.75f, 0.70f, 0.68f};
  std::array<LensDrop, kMaxDrops> drops{};
  int drop_count = 0;

  bool clean() const { return fog <= 0 && smear <= 0 && wipe < 0 && drop_count <= 0; }
};

}  // namespace trocar::render
