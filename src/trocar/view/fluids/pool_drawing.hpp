// What has gathered: the pool's cells as a sheet with a smooth border, and as films what runs down walls into it and
// the stain beside it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <trocar/view/fluids/fluid_sight.hpp>

namespace trocar::view {

class PoolDrawing {
 public:
  explicit PoolDrawing(const fluids::FluidsModel& model) : m_model(&model) {}

  /// Adds to the liquid's sheet and splats. Reads liquid.down.
  void list(const FluidSight& sight, render::Liquid& liquid);

 private:
  void list_sheet(const FluidSight& sight, render::Liquid& liquid);
  std::uint32_t corner(const FluidSight& sight, int i, int j, render::Liquid& liquid);
  void smooth_fields(const fluids::PoolState& pool, std::span<const float> floor);
  bool find_window(const fluids::PoolState& pool);
  void spread_level();
  void list_runs(const FluidSight& sight, render::Liquid& liquid) const;
  std::array<float, 2> floor_rise(std::span<const float> floor, int i, int j) const;
  float runs_down(const fluids::PoolState& pool, std::span<const float> floor, int i, int j) const;
  FilmPlace block_of(std::span<const float> floor, int i, int j) const;
  float tide_mark(int i, int j, const FilmPlace& place, int& wet_i, int& wet_j) const;
  float near_pool(int i, int j, int reach, int& wet_i, int& wet_j) const;

  const fluids::FluidsModel* m_model;
  /// The pool's cells that are drawn, row by row.
  struct Window {
    int i0 = 0, j0 = 0, width = 0, height = 0;
    std::size_t size() const { return std::size_t(width) * height; }
  } m_window;
  std::vector<float> m_depth, m_cover, m_level, m_known, m_scratch;
  std::vector<std::uint32_t> m_corner;
};

inline constexpr float kPoolShallow = 0.0015f;  ///< [m] what is less deep on a steep floor runs down it

}  // namespace trocar::view
