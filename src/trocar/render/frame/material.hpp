// How a surface looks: plain data, no tissue names here (view keeps the presets). Colours are linear RGB; srgb(r, g, b)
// converts the 0..255 values one reads off a picture. Lengths are metres in rest coordinates.
#pragma once

#include <cstdint>

#include <trocar/numerics/vec3.hpp>

namespace trocar::render {

/// 0..255 sRGB as read off a picture -> linear.
Vec3f srgb(float r, float g, float b);

enum class Shading : std::uint8_t {
  tissue,         ///< wet living surface
  metal,          ///< instrument: streaked along `fibre_axis`, mirrors the scene; or its insulation, see `scatter`
  fluid,          ///< pool or smear: smooth, glossy, mirrors; opaque by `density` times Paint::tint (its depth)
  vertex_colour,  ///< lit by wrap light only, paint is sRGB colour + alpha (false-colour maps, plastic); `wetness`
                  ///< glosses
  unlit,          ///< paint is sRGB colour + alpha, no light, no fall-off (lines, arrows, gizmos)
};

struct Material {
  Shading shading = Shading::tissue;

  // Three colours, mixed by two scales of noise. Keep them close: living tissue varies little in redness.
  Vec3f colour = {0.5f, 0.22f, 0.21f};     ///< main
  Vec3f colour_b = {0.55f, 0.27f, 0.25f};  ///< broad patches, wavelength mottle_size
  Vec3f colour_c = {0.42f, 0.16f, 0.16f};  ///< fine flecks, wavelength mottle_size / 5
  float mottle_size = 0.012f;              ///< [m]
  float mottle = 0.5f;                     ///< amount, 0..1
  Vec3f tint = {0.6f, 0.3f, 0.28f};        ///< where Paint::tint says

  // Relief, in rest space.
  float lobule_size = 0;         ///< [m] cell size of fat lobules, nodules, follicles; 0 = none
  float lobule_depth = 0;        ///< 0..1: how round the cells are shaded
  float lobule_contrast = 0;     ///< 0..1: how much darker and redder the seams are
  Vec3f fibre_axis = {0, 0, 1};  ///< unit, rest space: patterns are stretched along it
  float fibre_stretch = 1;       ///< >= 1: by this factor (muscle, ligament, brushed steel)
  float bump = 0.15f;            ///< 0..1: fine unevenness of the tissue itself

  // Serosal vessels: branching trees, projected along the rest normal; or the arcade of a fold, for meshes whose rest
  // coordinates are (along the fold, from border to root, 0).
  Vec3f vessel_colour = {0.23f, 0.03f, 0.045f};
  float vessels = 0;          ///< amount, 0..1
  float vessel_tile = 0.04f;  ///< [m] edge of one tile of the vessel picture (largest vessel = tile / 85 wide)
  bool arcade = false;        ///< vessel_tile is then the length of one bow along the fold, twice the fold's width
  /// The peritoneum of a cavity's wall: trunks with branches, drawn on a ball around `middle` from the pole
  /// `fibre_axis` on; fibres across (x) shimmer through; dull where nothing wets it.
  bool lining = false;
  Vec3f middle = {0, 0, 0};  ///< [m] rest space

  // Surface and film.
  float roughness = 0.45f;        ///< of the tissue under the film
  float wetness = 0.8f;           ///< 0 dry .. 1 film everywhere
  float film_roughness = 0.065f;  ///< 0.04..0.3; sharp: broken flecks, blunt: sheen
  float film_size = 0.003f;       ///< [m] wavelength of the film's ripples
  float film_bump = 0.30f;        ///< how much they break highlights up
  float fresnel = 0.026f;         ///< reflectance at normal incidence

  // Light inside the tissue.
  Vec3f wrap = {0.45f, 0.18f, 0.16f};  ///< how far light wraps past the terminator, per channel (red widest)
  Vec3f glow = {0.9f, 0.25f, 0.18f};   ///< colour of light that comes through a thin rim
  float glow_amount = 0.06f;           ///< 0..1
  float alpha = 1;                     ///< of translucent items, facing the eye; tint and vessels are denser
  float rim_alpha = 1;                 ///< of translucent items, grazing (a sheet seen edge-on is denser)

  // Shading::metal.
  float scatter = 0;  ///< 0 bare metal .. 1 ceramic, plastic: share of the light scattered instead of mirrored
  float soil = 1;     ///< share of Paint's blood and burn that is there

  float density = 1;       ///< Shading::fluid: opacity is 1 - exp(-density (1/4 + 4 tint)), tint = Paint::tint / 255
  bool two_sided = false;  ///< light both sides and do not cull (sheets, open surfaces)
};

}  // namespace trocar::render
