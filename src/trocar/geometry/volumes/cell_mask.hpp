// Which cells of an endless grid lie within a closed surface, or near an open one: a bit a cell, in the box around it.
// Cell (i, j, k) of a grid with edge `cell` spans [i, i + 1) x [j, j + 1) x [k, k + 1) cells; what counts is its
// middle.
//
//   const CellMask inside = cells_inside(skin.rest, skin.triangles, 0.5e-3);
//   if (inside.at(i, j, k)) ...
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry {

struct CellMask {
  double cell = 0;                 ///< [m]
  std::array<int, 3> first{};      ///< lowest cell of the box
  std::array<int, 3> count{};      ///< of its cells
  std::vector<std::uint8_t> bits;  ///< x fastest, eight a byte

  bool at(int i, int j, int k) const noexcept {
    const int x = i - first[0], y = j - first[1], z = k - first[2];
    if (x < 0 || y < 0 || z < 0 || x >= count[0] || y >= count[1] || z >= count[2]) return false;
    const std::size_t bit = number(x, y, z);
    return (bits[bit / 8] >> (bit % 8) & 1u) != 0;
  }
  std::size_t number(int x, int y, int z) const noexcept {
    return (std::size_t(z) * std::size_t(count[1]) + std::size_t(y)) * std::size_t(count[0]) + std::size_t(x);
  }
  void set(int x, int y, int z) noexcept {
    const std::size_t bit = number(x, y, z);
    bits[bit / 8] = std::uint8_t(bits[bit / 8] | (1u << (bit % 8)));
  }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("bits", s.bits), v("cell", s.cell, core::kNotHashed), v("first", s.first, core::kNotHashed),
        v("count", s.count, core::kNotHashed);
  }
};

using Triangles = std::span<const std::array<int, 3>>;

/// Inside what outward triangles wind around; where bodies overlap themselves, in both.
CellMask cells_inside(std::span<const Vec3f> points, Triangles triangles, double cell);
/// Within `reach` of any triangle.
CellMask cells_near(std::span<const Vec3f> points, Triangles triangles, double cell, double reach);

}  // namespace trocar::geometry
