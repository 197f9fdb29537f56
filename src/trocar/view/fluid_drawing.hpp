// What fluids look like in a frame: drops in flight become strands, drops on surfaces caps that merge, films stains,
// the pool a sheet with a smooth border. From a const State; the renderer makes one surface of it all
// (render/liquid.hpp).
//
//   view::FluidDrawing fluids(model);
//   fluids.list({.state = state, .floor = heights, .places = films}, frame);   // each frame, after SceneView::frame
//
// Not for the step: it allocates.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <trocar/fluids/fluids.hpp>
#include <trocar/fluids/optics.hpp>
#include <trocar/render/frame.hpp>
#include <trocar/view/wound.hpp>

namespace trocar::view {

struct FluidSight {
  const fluids::FluidsState& state;
  std::span<const float> floor = {};                ///< as PoolInput
  std::span<const FilmPlace> places = {};           ///< (film cells), or fewer: the rest is not drawn
  std::span<const std::uint8_t> sheer_bodies = {};  ///< by number of body: 1 where it is drawn translucent
  SurfaceNear surface = {};                         ///< for what runs down from a wound; may be empty
};

/// How blood, saline and bile look, in this order of the renderer's kinds.
render::LiquidLook liquid_look(const fluids::Optics& optics);

class FluidDrawing {
 public:
  explicit FluidDrawing(const fluids::FluidsModel& model, const fluids::Optics& optics = {});

  /// Adds to frame.liquid.
  void list(const FluidSight& sight, render::Frame& frame);

 private:
  struct Flying {
    std::uint32_t id;
    std::int32_t at;
    bool in_strand;
  };
  std::size_t next_in_strand(const fluids::DropletState& drops, std::size_t n) const;
  bool link(const fluids::DropletState& drops, std::int32_t i, std::int32_t j, render::Liquid& liquid) const;
  void list_flying(const FluidSight& sight, render::Liquid& liquid);
  void list_spray(const fluids::DropletState& drops, const Flying& drop, render::Liquid& liquid) const;
  void list_holes(const FluidSight& sight, render::Liquid& liquid) const;
  void list_lying(const fluids::DropletState& drops, std::span<const std::uint8_t> sheer, render::Liquid& liquid);
  void list_splash(const fluids::DropletState& drops, std::int32_t i, bool sheer, render::Liquid& liquid) const;
  void list_films(const FluidSight& sight, render::Liquid& liquid);
  void list_pool(const FluidSight& sight, render::Liquid& liquid);
  void list_runs(const FluidSight& sight, render::Liquid& liquid) const;
  std::array<float, 2> floor_rise(std::span<const float> floor, int i, int j) const;
  float runs_down(const fluids::PoolState& pool, std::span<const float> floor, int i, int j) const;
  FilmPlace block_of(std::span<const float> floor, int i, int j) const;
  float tide_mark(int i, int j, const FilmPlace& place, int& wet_i, int& wet_j) const;
  float near_pool(int i, int j, int reach, int& wet_i, int& wet_j) const;
  void smooth_pool(const fluids::PoolState& pool, std::span<const float> floor);

  const fluids::FluidsModel* m_model;
  render::LiquidLook m_look;
  Vec3f m_eye{0, 0, 0};  ///< the camera
  std::vector<Flying> m_flying;
  /// The pool's cells that are drawn, row by row.
  struct Window {
    int i0 = 0, j0 = 0, width = 0, height = 0;
    std::size_t size() const { return std::size_t(width) * height; }
  } m_window;
  std::vector<float> m_depth, m_cover, m_level, m_known, m_scratch;
  std::vector<std::uint32_t> m_corner;
};

}  // namespace trocar::view
