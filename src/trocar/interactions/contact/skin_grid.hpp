// The nearest vertex of a skin that never moves, as quick as a look into a list: cells of some millimetres, each with
// the vertices that can be nearest to a point in it. Made once; says the same as nearest_vertex_near, to the vertex.
//
//   const SkinGrid grid = make_skin_grid(wall.skin, reach);
//   const int vertex = grid.nearest(wall.skin, p);      // -1: none within reach
#pragma once

#include <cstdint>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/tissue/network/skin.hpp>

namespace trocar::interactions {

struct SkinGrid {
  Vec3d origin;
  double reach = 0;     ///< [m]
  double per_cell = 0;  ///< 1 / edge of a cell [1/m]
  std::array<int, 3> cells{0, 0, 0};
  std::vector<std::int32_t> first, vertex;  ///< CSR over cells, ascending
  std::vector<std::uint64_t> filled;        ///< a bit a cell: has it any? Small enough to be at hand

  int nearest(const tissue::Skin& skin, Vec3d p) const noexcept;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("origin", s.origin), v("reach", s.reach), v("per_cell", s.per_cell), v("cells", s.cells), v("first", s.first),
        v("vertex", s.vertex), v("filled", s.filled);
  }
};

/// @param reach  [m]
SkinGrid make_skin_grid(const tissue::Skin& skin, double reach);

}  // namespace trocar::interactions
