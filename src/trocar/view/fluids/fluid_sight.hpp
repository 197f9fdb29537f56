// What the parts of FluidDrawing look at.
#pragma once

#include <cstdint>
#include <span>

#include <trocar/fluids/fluids.hpp>
#include <trocar/view/fluids/wound.hpp>

namespace trocar::view {

struct FluidSight {
  const fluids::FluidsState& state;
  std::span<const float> floor = {};                ///< as PoolInput
  std::span<const FilmPlace> places = {};           ///< (film cells), or fewer: the rest is not drawn
  std::span<const std::uint8_t> sheer_bodies = {};  ///< by number of body: 1 where it is drawn translucent
  SurfaceNear surface = {};                         ///< for what runs down from a wound; may be empty
};

}  // namespace trocar::view
