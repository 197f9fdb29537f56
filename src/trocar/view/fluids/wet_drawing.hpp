// The fluids of a scene in its picture: where places of film lie now, which bodies are drawn translucent; the rest is
// FluidDrawing's.
#pragma once

#include <vector>

#include <trocar/interactions/wetting/fluid_contact.hpp>
#include <trocar/sim/model/state.hpp>
#include <trocar/sim/model/vessel_cuts.hpp>
#include <trocar/view/fluids/fluid_drawing.hpp>

namespace trocar::view {

class WetDrawing {
 public:
  /// @param model  with fluids; must outlive this
  explicit WetDrawing(const sim::Model& model);

  /// Adds to frame.liquid.
  void list(const sim::State& state, render::Frame& frame);

 private:
  void measure_places();
  void pose(const sim::State& state);
  void list_stumps(const sim::State& state, render::Liquid& liquid) const;
  void list_runs(const sim::State& state, render::Liquid& liquid);
  FilmPlace on_strand(const sim::State& state, const FilmPlace& place) const;

  const sim::Model* m_model;
  FluidDrawing m_drawing;
  std::vector<tissue::SkinPose> m_poses;  ///< (organs, membranes)
  interactions::BodyWork m_bodies;        ///< surfaces and sheets, posed
  std::vector<FilmPlace> m_places;        ///< (film cells)
  std::vector<std::uint8_t> m_sheer;      ///< (bodies)
};

}  // namespace trocar::view
