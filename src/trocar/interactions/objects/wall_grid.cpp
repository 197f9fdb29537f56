#include <algorithm>
#include <cmath>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/objects/wall_grid.hpp>

namespace trocar::interactions {
namespace {

constexpr std::int32_t kMostWallCells = 1 << 21;

/// Cells from one corner to another, both included.
struct Cells {
  std::array<std::int32_t, 3> low, high;
};
Cells cells_of(const WallGrid& g, const WallGrid::Triangle& t) {
  Cells cells;
  for (int k = 0; k < 3; ++k) {
    const double least = std::min({t.a[k], t.b[k], t.c[k]}) - g.reach,
                 most = std::max({t.a[k], t.b[k], t.c[k]}) + g.reach;
    cells.low[size_t(k)] = std::max(0, std::int32_t(std::floor((least - g.origin[k]) / g.cell)));
    cells.high[size_t(k)] = std::min(g.size[size_t(k)] - 1, std::int32_t(std::floor((most - g.origin[k]) / g.cell)));
  }
  return cells;
}
std::int32_t number_of(const WallGrid& g, std::int32_t i, std::int32_t j, std::int32_t k) noexcept {
  return (k * g.size[1] + j) * g.size[0] + i;
}
template <class F>
void for_cells(const WallGrid& g, const WallGrid::Triangle& t, F&& f) {
  const Cells c = cells_of(g, t);
  for (std::int32_t k = c.low[2]; k <= c.high[2]; ++k)
    for (std::int32_t j = c.low[1]; j <= c.high[1]; ++j)
      for (std::int32_t i = c.low[0]; i <= c.high[0]; ++i) f(size_t(number_of(g, i, j, k)));
}

void add_triangles(const tissue::Skin& skin, std::int32_t wall, WallGrid& g) {
  for (const std::array<int, 3>& t : skin.triangles) {
    const auto x = [&](size_t k) { return vec_cast<double>(skin.rest[size_t(t[k])]); };
    const Vec3d normal = cross(x(1) - x(0), x(2) - x(0));
    if (!(dot(normal, normal) > 0)) continue;
    g.triangles.push_back({x(0), x(1), x(2), normalised(normal), wall});
  }
}

void lay_out(WallGrid& g) {
  Vec3d low = g.triangles.front().a, high = low;
  for (const WallGrid::Triangle& t : g.triangles)
    for (const Vec3d p : {t.a, t.b, t.c})
      for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  g.origin = low - Vec3d{g.reach, g.reach, g.reach};
  const Vec3d whole = high - low + 2 * g.reach * Vec3d{1, 1, 1};
  g.cell = g.reach;
  double cells = 0;
  do {
    cells = 1;
    for (int k = 0; k < 3; ++k) cells *= double(g.size[size_t(k)] = std::int32_t(std::floor(whole[k] / g.cell)) + 1);
    if (cells > kMostWallCells) g.cell *= 1.3;
  } while (cells > kMostWallCells);
}

}  // namespace

WallGrid make_wall_grid(std::span<const tissue::Skin* const> walls, double reach) {
  WallGrid g;
  g.reach = reach;
  for (size_t i = 0; i < walls.size(); ++i) add_triangles(*walls[i], std::int32_t(i), g);
  if (g.empty()) return g;
  lay_out(g);
  g.first.assign(size_t(g.size[0]) * size_t(g.size[1]) * size_t(g.size[2]) + 1, 0);
  for (const WallGrid::Triangle& t : g.triangles) for_cells(g, t, [&](size_t cell) { ++g.first[cell + 1]; });
  for (size_t c = 1; c < g.first.size(); ++c) g.first[c] += g.first[c - 1];
  g.in_cell.resize(size_t(g.first.back()));
  std::vector<std::int32_t> at(g.first.begin(), g.first.end() - 1);
  for (size_t t = 0; t < g.triangles.size(); ++t)
    for_cells(g, g.triangles[t], [&](size_t cell) { g.in_cell[size_t(at[cell]++)] = std::int32_t(t); });
  return g;
}

WallPlaces walls_near(const WallGrid& g, Vec3d p) noexcept {
  WallPlaces found;
  if (g.empty()) return found;
  std::array<std::int32_t, 3> cell;
  for (int k = 0; k < 3; ++k) {
    const double at = std::floor((p[k] - g.origin[k]) / g.cell);
    if (!(at >= 0 && at < double(g.size[size_t(k)]))) return found;
    cell[size_t(k)] = std::int32_t(at);
  }
  const size_t c = size_t(number_of(g, cell[0], cell[1], cell[2]));
  for (std::int32_t i = g.first[c]; i < g.first[c + 1]; ++i) {
    const WallGrid::Triangle& t = g.triangles[size_t(g.in_cell[size_t(i)])];
    if (std::fabs(dot(p - t.a, t.normal)) > g.reach) continue;
    const auto near = geometry::closest_on_triangle(p, t.a, t.b, t.c);
    const double away = std::sqrt(near.distance2);
    if (away > g.reach) continue;
    WallPlace* place = std::find_if(found.list.data(), found.list.data() + found.count,
                                    [&t](const WallPlace& w) { return w.wall == t.wall; });
    const bool fresh = place == found.list.data() + found.count;
    if (fresh && found.count == kMostWalls) continue;
    // Beside a triangle's rim a point is behind it where another one's normal says so: the one that faces it most.
    const Vec3d off = p - near.point;
    const double above = dot(off, t.normal), signed_away = above < 0 ? -away : away;
    if (!fresh) {
      const double was = std::fabs(place->distance);
      const bool nearer = away < was - 1e-12, same = away <= was + 1e-12;
      if (!nearer && !(same && std::fabs(above) > std::fabs(dot(p - place->point, place->normal)))) continue;
    } else {
      ++found.count;
    }
    const Vec3d up = away > 1e-9 ? (above < 0 ? -1.0 : 1.0) / away * off : t.normal;
    *place = {near.point, up, signed_away, t.wall};
  }
  return found;
}

}  // namespace trocar::interactions
