#include <algorithm>
#include <cmath>

#include <trocar/render/backend/packing.hpp>
#include <trocar/render/meshes/patterns.hpp>

namespace trocar::render {

std::array<float, 14 * 4> packed(const Material& m) {
  const float noise = 1 / (kNoiseFeatures * m.mottle_size);
  const float rough = m.roughness * m.roughness;
  const float cells = m.lobule_size > 0 ? 1 / (kCellFeatures * m.lobule_size) : 0;
  return {m.colour.x,
          m.colour.y,
          m.colour.z,
          m.mottle,
          m.colour_b.x,
          m.colour_b.y,
          m.colour_b.z,
          noise,
          m.colour_c.x,
          m.colour_c.y,
          m.colour_c.z,
          m.bump,
          m.tint.x,
          m.tint.y,
          m.tint.z,
          m.wetness,
          m.fibre_axis.x,
          m.fibre_axis.y,
          m.fibre_axis.z,
          1 - 1 / m.fibre_stretch,
          m.vessel_colour.x,
          m.vessel_colour.y,
          m.vessel_colour.z,
          m.vessels,
          m.wrap.x,
          m.wrap.y,
          m.wrap.z,
          1 / m.vessel_tile,
          m.glow.x,
          m.glow.y,
          m.glow.z,
          m.glow_amount,
          rough * rough,
          m.film_roughness * m.film_roughness,
          1 / (kNoiseFeatures * m.film_size),
          m.film_bump,
          m.fresnel,
          m.alpha,
          m.rim_alpha,
          m.density,
          cells,
          m.lobule_depth,
          m.lobule_contrast,
          m.scatter,
          m.soil,
          m.middle.x,
          m.middle.y,
          m.middle.z};
}

std::array<float, 8 * 4> packed(const Frame& frame) {
  const Light& l = frame.light;
  const Vec3f bounce = l.bounce * l.bounce_colour;
  const Vec3f fog = frame.look.fog_colour;
  return {l.position.x, l.position.y,
          l.position.z, l.intensity,
          l.colour.x,   l.colour.y,
          l.colour.z,   l.reference_distance * l.reference_distance,
          bounce.x,     bounce.y,
          bounce.z,     l.inverse_square ? 1.0f : 0.0f,
          fog.x,        fog.y,
          fog.z,        frame.look.fog,
          l.ambient,    0,
          l.ring,       l.crevices};
}

}  // namespace trocar::render
