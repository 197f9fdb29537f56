#include <algorithm>
#include <cmath>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/geometry/volumes/cell_mask.hpp>

namespace trocar::geometry {
namespace {

int cell_of(double x, double cell) noexcept { return int(std::floor(x / cell)); }

CellMask empty_mask(std::span<const Vec3f> points, Triangles triangles, double cell, double margin) {
  CellMask mask;
  mask.cell = cell;
  if (triangles.empty()) return mask;
  Vec3d low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  for (const auto& t : triangles)
    for (const int corner : t) {
      const Vec3d p = vec_cast<double>(points[std::size_t(corner)]);
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  std::size_t cells = 1;
  for (int c = 0; c < 3; ++c) {
    mask.first[std::size_t(c)] = cell_of(low[c] - margin, cell);
    mask.count[std::size_t(c)] = cell_of(high[c] + margin, cell) - mask.first[std::size_t(c)] + 1;
    cells *= std::size_t(mask.count[std::size_t(c)]);
  }
  mask.bits.assign((cells + 7) / 8, 0);
  return mask;
}

/// Where a line along x meets a triangle, and whether it goes in (1) or out (-1) there.
struct LineCrossing {
  std::size_t line;
  double x;
  int way;
};

/// Twice the area of (a, b, p) in the plane y z.
double twice_area_yz(Vec3d a, Vec3d b, double y, double z) noexcept {
  return (b.y - a.y) * (z - a.z) - (b.z - a.z) * (y - a.y);
}

/// Lines through the middles of cells that meet triangle t. An edge is always looked at from its corner of the lower
/// number, so that of two triangles at an edge exactly one has a line that passes through it.
void cross(std::span<const Vec3f> points, const std::array<int, 3>& t, const CellMask& mask,
           std::vector<LineCrossing>& out) {
  Vec3d p[3];
  for (std::size_t c = 0; c < 3; ++c) p[c] = vec_cast<double>(points[std::size_t(t[c])]);
  const auto [y0, y1] = std::minmax({p[0].y, p[1].y, p[2].y});
  const auto [z0, z1] = std::minmax({p[0].z, p[1].z, p[2].z});
  const auto first = [&](double v, std::size_t c) { return std::max(cell_of(v, mask.cell) - mask.first[c], 0); };
  const auto last = [&](double v, std::size_t c) {
    return std::min(cell_of(v, mask.cell) - mask.first[c], mask.count[c] - 1);
  };
  for (int k = first(z0, 2); k <= last(z1, 2); ++k)
    for (int j = first(y0, 1); j <= last(y1, 1); ++j) {
      const double y = (mask.first[1] + j + 0.5) * mask.cell, z = (mask.first[2] + k + 0.5) * mask.cell;
      double weight[3];
      int left = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t d = (c + 1) % 3;
        const bool forward = t[c] < t[d];
        const double area = forward ? twice_area_yz(p[c], p[d], y, z) : twice_area_yz(p[d], p[c], y, z);
        left += (area >= 0) == forward;
        weight[(c + 2) % 3] = forward ? area : -area;
      }
      const double whole = weight[0] + weight[1] + weight[2];
      if ((left != 0 && left != 3) || whole == 0) continue;
      const double x = (weight[0] * p[0].x + weight[1] * p[1].x + weight[2] * p[2].x) / whole;
      // Seen along x, corners that turn left belong to a side that looks along x: the line leaves there.
      out.push_back({std::size_t(k) * std::size_t(mask.count[1]) + std::size_t(j), x, left == 3 ? -1 : 1});
    }
}

void fill(CellMask& mask, std::size_t line, double from, double to) {
  const int y = int(line % std::size_t(mask.count[1])), z = int(line / std::size_t(mask.count[1]));
  const int begin = std::max(int(std::ceil(from / mask.cell - 0.5)) - mask.first[0], 0);
  for (int x = begin; x < mask.count[0] && (mask.first[0] + x + 0.5) * mask.cell < to; ++x) mask.set(x, y, z);
}

}  // namespace

CellMask cells_inside(std::span<const Vec3f> points, Triangles triangles, double cell) {
  CellMask mask = empty_mask(points, triangles, cell, 0);
  std::vector<LineCrossing> crossings;
  for (const auto& t : triangles) cross(points, t, mask, crossings);
  std::sort(crossings.begin(), crossings.end(), [](const LineCrossing& a, const LineCrossing& b) {
    return a.line != b.line ? a.line < b.line : a.x != b.x ? a.x < b.x : a.way > b.way;
  });
  int depth = 0;
  for (std::size_t n = 0; n < crossings.size(); ++n) {
    const bool same = n > 0 && crossings[n].line == crossings[n - 1].line;
    if (!same) depth = 0;
    if (same && depth > 0) fill(mask, crossings[n].line, crossings[n - 1].x, crossings[n].x);
    depth += crossings[n].way;
  }
  return mask;
}

CellMask cells_near(std::span<const Vec3f> points, Triangles triangles, double cell, double reach) {
  CellMask mask = empty_mask(points, triangles, cell, reach);
  for (const auto& t : triangles) {
    Vec3d p[3], low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
    for (std::size_t c = 0; c < 3; ++c) p[c] = vec_cast<double>(points[std::size_t(t[c])]);
    int from[3], to[3];
    for (int c = 0; c < 3; ++c) {
      low[c] = std::min({p[0][c], p[1][c], p[2][c]}), high[c] = std::max({p[0][c], p[1][c], p[2][c]});
      from[c] = cell_of(low[c] - reach, cell) - mask.first[std::size_t(c)];
      to[c] = cell_of(high[c] + reach, cell) - mask.first[std::size_t(c)];
    }
    for (int z = from[2]; z <= to[2]; ++z)
      for (int y = from[1]; y <= to[1]; ++y)
        for (int x = from[0]; x <= to[0]; ++x) {
          const Vec3d middle = cell * Vec3d{mask.first[0] + x + 0.5, mask.first[1] + y + 0.5, mask.first[2] + z + 0.5};
          if (closest_on_triangle(middle, p[0], p[1], p[2]).distance2 <= reach * reach) mask.set(x, y, z);
        }
  }
  return mask;
}

}  // namespace trocar::geometry
