// What lies on tissue: stains that a place keeps, and drops that run there. Blood is a film at once, other fluids are
// caps.
#pragma once

#include <trocar/view/fluids/fluid_sight.hpp>

namespace trocar::view {

class FilmDrawing {
 public:
  explicit FilmDrawing(const fluids::FluidsModel& model) : m_model(&model) {}

  /// Adds to liquid.splats. Reads liquid.down.
  void list(const FluidSight& sight, render::Liquid& liquid) const;

 private:
  void list_films(const FluidSight& sight, render::Liquid& liquid) const;
  void list_lying(const fluids::DropletState& drops, std::span<const std::uint8_t> sheer, render::Liquid& liquid) const;
  void list_cap(const fluids::DropletState& drops, std::int32_t i, bool sheer, render::Liquid& liquid) const;
  void list_splash(const fluids::DropletState& drops, std::int32_t i, bool sheer, render::Liquid& liquid) const;

  const fluids::FluidsModel* m_model;
};

}  // namespace trocar::view
