// What flies: drops that left one after the other are a jet, whole near its hole and torn into beads and spray further
// off, others rain; and a jet's hole bleeds.
#pragma once

#include <cstdint>
#include <vector>

#include <trocar/view/fluids/fluid_sight.hpp>

namespace trocar::view {

class JetDrawing {
 public:
  explicit JetDrawing(const fluids::FluidsModel& model) : m_model(&model) {}

  /// Adds to liquid.splats. Reads liquid.down.
  /// @param eye  the camera [m] world
  void list(const FluidSight& sight, Vec3f eye, render::Liquid& liquid);

 private:
  struct Flying {
    std::uint32_t id;
    std::int32_t at;
    bool in_strand;
  };
  void gather(const fluids::DropletState& drops);
  std::size_t next_in_strand(const fluids::DropletState& drops, std::size_t n) const;
  void list_holes(const FluidSight& sight, Vec3f eye, render::Liquid& liquid) const;

  const fluids::FluidsModel* m_model;
  std::vector<Flying> m_flying;  ///< the last to leave first
};

}  // namespace trocar::view
