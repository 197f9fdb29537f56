// Points that do not move, in cubic cells, to find those near a place.
//
//   const PointGrid grid(points, 0.008);
//   grid.visit(place, 0.02, [&](std::uint32_t i) { ... });    // all of them that are at most 20 mm away, and some more
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry {

class PointGrid {
 public:
  /// @param cell edge [m]; larger where there would be too many. @param taken which points count; empty: all
  PointGrid(std::span<const Vec3f> points, float cell, std::span<const std::uint8_t> taken = {});

  /// Calls each(number) for all points within `reach` [m] of p, and for others in the same cells.
  template <class Each>
  void visit(Vec3f p, float reach, Each&& each) const {
    const auto [low, high] = cells_around(p, reach);
    for (int k = low[2]; k <= high[2]; ++k)
      for (int j = low[1]; j <= high[1]; ++j) {
        const std::size_t row = std::size_t(k * m_size[1] + j) * std::size_t(m_size[0]);
        for (std::uint32_t n = m_start[row + std::size_t(low[0])]; n < m_start[row + std::size_t(high[0]) + 1]; ++n)
          each(m_number[n]);
      }
  }
  bool empty() const { return m_number.empty(); }
  float cell() const { return m_cell; }  ///< [m]

 private:
  struct Cells {
    std::array<int, 3> low{0, 0, 0}, high{-1, -1, -1};
  };
  Cells cells_around(Vec3f p, float reach) const;
  int along(float x, int axis) const;

  float m_cell;
  Vec3f m_low;
  std::array<int, 3> m_size{};
  std::vector<std::uint32_t> m_start, m_number;  ///< first of each cell, and the end; numbers, ascending in a cell
};

}  // namespace trocar::geometry
