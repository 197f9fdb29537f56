// Polygons of files into triangles: as a fan where they are convex, in halves where they have many corners, else ear by
// ear in the plane that fits them best.
//
//   PolygonCutter cutter;                     // one a file: its work is bounded over all polygons
//   cutter.cut(positions, corners, triangles);
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry {

class PolygonCutter {
 public:
  /// Appends corners - 2 triangles that run around as the polygon does. At least three corners, all of them there; less
  /// gives nothing. One that crosses itself gives triangles, too, only no good ones.
  void cut(std::span<const Vec3d> positions, std::span<const int> corners, std::vector<std::array<int, 3>>& triangles);
  /// Polygons that were not convex, and cut as fans all the same: too many corners, or too much work.
  int fans() const { return m_fans; }

 private:
  std::int64_t m_steps = 0;
  int m_fans = 0;
};

}  // namespace trocar::geometry
