// What fluids look like in a frame: drops in flight become strands, drops on surfaces caps that merge, films stains,
// the pool a sheet with a smooth border. From a const State; the renderer makes one surface of it all
// (render/frame/liquid.hpp).
//
//   view::FluidDrawing fluids(model);
//   fluids.list({.state = state, .floor = heights, .places = films}, frame);   // each frame, after SceneView::frame
//
// Not for the step: it allocates.
#pragma once

#include <trocar/fluids/fluids.hpp>
#include <trocar/fluids/optics.hpp>
#include <trocar/render/frame/frame.hpp>
#include <trocar/view/fluids/film_drawing.hpp>
#include <trocar/view/fluids/jet_drawing.hpp>
#include <trocar/view/fluids/pool_drawing.hpp>

namespace trocar::view {

/// How blood, saline and bile look, in this order of the renderer's kinds.
render::LiquidLook liquid_look(const fluids::Optics& optics);

class FluidDrawing {
 public:
  explicit FluidDrawing(const fluids::FluidsModel& model, const fluids::Optics& optics = {});

  /// Adds to frame.liquid.
  void list(const FluidSight& sight, render::Frame& frame);

 private:
  const fluids::FluidsModel* m_model;
  render::LiquidLook m_look;
  PoolDrawing m_pool;
  FilmDrawing m_film;
  JetDrawing m_jet;
};

}  // namespace trocar::view
