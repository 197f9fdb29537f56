// What parts tissue: a flat convex polygon, as closing blades sweep it or as a tear opens.
//
//   const BladePlane plane(blade);
//   if (plane.crosses(a, b)) ...
#pragma once

#include <array>

#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry {

/// Corners in order.
struct Blade {
  static constexpr int kMostCorners = 8;
  std::array<Vec3d, kMostCorners> corner{};
  int corners = 0;
};

/// A square around `middle`, across the unit vector `normal`. @param half  of its edge [m]
inline Blade square_blade(Vec3d middle, Vec3d normal, double half) noexcept {
  const Vec3d u = any_perpendicular(normal), v = cross(normal, u);
  Blade b;
  for (const auto& [s, t] : {std::array{-1, -1}, std::array{1, -1}, std::array{1, 1}, std::array{-1, 1}})
    b.corner[std::size_t(b.corners++)] = middle + half * (double(s) * u + double(t) * v);
  return b;
}

/// The blade's plane, and its edges' inward normals in it.
struct BladePlane {
  Vec3d origin, n;
  std::array<Vec3d, Blade::kMostCorners> inward;
  const Blade& blade;
  bool flat = false;  ///< it has an area, without which it parts nothing

  explicit BladePlane(Blade&&) = delete;  // it keeps a reference
  explicit BladePlane(const Blade& b) noexcept : blade(b) {
    for (int i = 2; i < b.corners; ++i) n += cross(b.corner[i - 1] - b.corner[0], b.corner[i] - b.corner[0]);
    const double size = length(n);
    flat = b.corners >= 3 && size > 0;
    if (!flat) return;
    n = n / size;
    for (int i = 0; i < b.corners; ++i) {
      origin += b.corner[i] / double(b.corners);
      inward[i] = cross(n, b.corner[(i + 1) % b.corners] - b.corner[i]);
    }
  }
  double height(Vec3d p) const noexcept { return dot(p - origin, n); }
  /// A point of the plane lies within the polygon.
  bool covers(Vec3d p) const noexcept {
    for (int i = 0; i < blade.corners; ++i)
      if (dot(p - blade.corner[i], inward[i]) < 0) return false;
    return true;
  }
  bool crosses(Vec3d a, Vec3d b) const noexcept {
    const double ha = height(a), hb = height(b);
    return (ha > 0) != (hb > 0) && covers(a + (ha / (ha - hb)) * (b - a));
  }
};

}  // namespace trocar::geometry
