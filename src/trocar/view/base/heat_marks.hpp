// What heat has left on a surface that is drawn: how burnt its vertices are (render::Paint::burn), from the heat at
// their material places. Worked out again only where heat is or was.
#pragma once

#include <span>
#include <vector>

#include <trocar/sim/model/state.hpp>
#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

/// 0 none, about 100 coagulated, 180 dried, 255 charred: as Paint::burn reads it.
std::uint8_t burn_of(const tissue::HeatReading& reading);

class HeatMarks {
 public:
  /// @param body    as holds name it (core/body_id.hpp)
  /// @param places  of the vertices in that body's frame of heat [m], a little inside the tissue
  HeatMarks(const sim::Model& model, BodyId body, std::vector<Vec3d> places = {});

  /// True where a burn has changed since the last time.
  bool update(const sim::State& state);
  bool any() const { return m_any; }
  std::uint8_t burn(std::size_t vertex) const { return m_burn[vertex]; }

  /// Is there heat in this body that may have changed since this was last asked? For who asks reading() himself.
  bool stirred(const sim::State& state);
  std::uint8_t burn_at(const sim::State& state, Vec3d place) const;

 private:
  std::uint8_t smoothed(std::span<const std::size_t> there, std::span<const float> burn, Vec3d place) const;

  const sim::Model* m_model;
  BodyId m_body;
  std::vector<Vec3d> m_places;
  std::vector<std::uint8_t> m_burn;
  std::uint64_t m_tick = ~0ull;
  bool m_any = false;
};

/// Places of a skin's vertices, a little below it as drawn.
std::vector<Vec3d> below_skin(const tissue::Skin& skin);

}  // namespace trocar::view
