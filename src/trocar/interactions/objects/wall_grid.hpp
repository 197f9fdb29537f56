// Triangles of walls that never move, in a grid, for balls that touch them: what is near a point is found without a
// search, whatever the size of the triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/tissue/network/skin.hpp>

namespace trocar::interactions {

struct WallGrid {
  struct Triangle {
    Vec3d a, b, c;
    Vec3d normal;  ///< to the free side, unit
    std::int32_t wall = 0, reserved = 0;

    static constexpr bool kAsBytes = true;
    template <class S, class V>
    static void fields(S& s, V&& v) {
      v("a", s.a), v("b", s.b), v("c", s.c), v("normal", s.normal), v("wall", s.wall), v("reserved", s.reserved);
    }
  };
  std::vector<Triangle> triangles;
  double cell = 0;   ///< [m]
  double reach = 0;  ///< of a point: triangles further away are not found [m]
  Vec3d origin;
  std::array<std::int32_t, 3> size{0, 0, 0};
  std::vector<std::int32_t> first;    ///< (cells + 1)
  std::vector<std::int32_t> in_cell;  ///< triangles

  bool empty() const noexcept { return triangles.empty(); }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("triangles", s.triangles), v("cell", s.cell), v("reach", s.reach), v("origin", s.origin), v("size", s.size),
        v("first", s.first), v("in_cell", s.in_cell);
  }
};

/// @param reach  [m]
WallGrid make_wall_grid(std::span<const tissue::Skin* const> walls, double reach);

/// The nearest place of a wall.
struct WallPlace {
  Vec3d point, normal;  ///< normal: from there to the ball's middle, to the free side
  double distance = 0;  ///< of the middle, negative behind [m]
  std::int32_t wall = -1;
};
inline constexpr int kMostWalls = 4;  ///< that a ball touches at once
struct WallPlaces {
  std::array<WallPlace, kMostWalls> list;
  int count = 0;
};
/// Of each wall within reach of p the place nearest to it; the first few walls.
WallPlaces walls_near(const WallGrid& grid, Vec3d p) noexcept;

}  // namespace trocar::interactions
