#include <algorithm>
#include <cmath>

#include <trocar/fluids/pool_bed.hpp>

namespace trocar::fluids {
namespace {

constexpr double kUpright = 1e-6;       // [cells^2] a triangle that covers less from above raises nothing
constexpr double kBeyondPatient = 1e6;  // [cells], [m]: not finite, or not in a patient

struct Span {
  int first = 0, last = 0;  ///< the last one not included
};

/// Cells whose middles lie between the least and the greatest of three coordinates, within `bounds`.
Span cells_between(double a, double b, double c, Span bounds) noexcept {
  const double low = std::clamp(std::min({a, b, c}) - 0.5, double(bounds.first), double(bounds.last));
  const double high = std::clamp(std::max({a, b, c}) - 0.5, double(bounds.first) - 1, double(bounds.last) - 1);
  return {int(std::ceil(low)), int(std::floor(high)) + 1};
}

}  // namespace

Vec3d in_cells(const PoolModel& m, Vec3d p) noexcept {
  const Vec3d d = p - m.origin;
  return {dot(d, m.u) / m.cell, dot(d, m.v) / m.cell, dot(d, m.up)};
}

void raise_bed(const PoolModel& m, const std::array<Vec3d, 3>& p, int first, int last, std::span<float> bed) noexcept {
  const Vec3d ab = p[1] - p[0], ac = p[2] - p[0];
  const double area = ab.x * ac.y - ab.y * ac.x;  // twice, seen from above; positive: it looks up
  if (!(area > kUpright)) return;
  for (const Vec3d& corner : p)
    for (int axis = 0; axis < 3; ++axis)
      if (!(std::fabs(corner[axis]) < kBeyondPatient)) return;
  const Span rows = cells_between(p[0].y, p[1].y, p[2].y, {first, last});
  const Span columns = cells_between(p[0].x, p[1].x, p[2].x, {0, m.nx});
  for (int j = rows.first; j < rows.last; ++j)
    for (int i = columns.first; i < columns.last; ++i) {
      const double x = i + 0.5 - p[0].x, y = j + 0.5 - p[0].y;
      const double b = (x * ac.y - y * ac.x) / area, c = (ab.x * y - ab.y * x) / area;
      if (!(b >= 0 && c >= 0 && b + c <= 1)) continue;
      float& height = bed[std::size_t(j) * std::size_t(m.nx) + std::size_t(i)];
      height = std::max(height, float(p[0].z + b * ab.z + c * ac.z));
    }
}

}  // namespace trocar::fluids
