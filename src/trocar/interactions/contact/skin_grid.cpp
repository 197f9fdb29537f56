#include <algorithm>
#include <cmath>
#include <vector>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/contact/skin_grid.hpp>

namespace trocar::interactions {
namespace {

constexpr double kFinest = 0.004;       // [m] edge of a cell
constexpr double kMostSkinCells = 1e5;  // larger cells rather than more
constexpr double kGridRounding = 1e-7;  // [m] far more than what rounding misplaces

double squared(double x) { return x * x; }

/// A cell as a box in space.
struct Cell {
  Vec3d low, high;

  /// Of the place in it that is nearest to p, and of the one that is farthest.
  double nearest2(Vec3d p) const {
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += squared(std::max({low[k] - p[k], 0.0, p[k] - high[k]}));
    return sum;
  }
  double farthest2(Vec3d p) const {
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += squared(std::max(std::fabs(low[k] - p[k]), std::fabs(high[k] - p[k])));
    return sum;
  }
};

/// Leaves in `within` the vertices that some place of the cell may be nearest to.
void keep_candidates(const tissue::Skin& skin, const Cell& cell, std::vector<std::int32_t>& within) {
  double bound = 1e30;
  const auto at = [&](std::int32_t v) { return vec_cast<double>(skin.rest[size_t(v)]); };
  for (const std::int32_t v : within) bound = std::min(bound, std::sqrt(cell.farthest2(at(v))) + kGridRounding);
  std::erase_if(within, [&](std::int32_t v) { return cell.nearest2(at(v)) > squared(bound); });
}

}  // namespace

int SkinGrid::nearest(const tissue::Skin& skin, Vec3d p) const noexcept {
  int at[3];
  for (int k = 0; k < 3; ++k) {
    const double q = (p[k] - origin[k]) * per_cell;
    if (!(q >= 0 && q < cells[size_t(k)])) return -1;
    at[k] = int(q);
  }
  const size_t cell = (size_t(at[2]) * size_t(cells[1]) + size_t(at[1])) * size_t(cells[0]) + size_t(at[0]);
  if ((filled[cell / 64] >> (cell % 64) & 1u) == 0) return -1;
  int best = -1;
  double least = reach * reach;
  for (std::int32_t i = first[cell]; i < first[cell + 1]; ++i) {
    const std::int32_t v = vertex[size_t(i)];
    const double d = geometry::distance2(vec_cast<double>(skin.rest[size_t(v)]), p);
    if (d >= least) continue;
    least = d;
    best = v;
  }
  return best;
}

SkinGrid make_skin_grid(const tissue::Skin& skin, double reach) {
  SkinGrid grid;
  grid.reach = reach;
  tissue::Box bounds;
  for (int v = 0; v < skin.size(); ++v)
    if (skin.at_surface(v)) bounds.add(skin.rest[size_t(v)]);
  const double margin = reach + 1e-4;
  grid.origin = vec_cast<double>(bounds.low) - Vec3d{margin, margin, margin};
  Vec3d size = vec_cast<double>(bounds.high) + Vec3d{margin, margin, margin} - grid.origin;
  for (int k = 0; k < 3; ++k) size[k] = std::clamp(size[k], kFinest, 100.0);
  double edge = kFinest;
  while (size.x * size.y * size.z > kMostSkinCells * edge * edge * edge) edge *= 1.25;
  grid.per_cell = 1 / edge;
  for (int k = 0; k < 3; ++k) grid.cells[size_t(k)] = int(size[k] / edge) + 2;
  std::vector<std::vector<std::int32_t>> within(size_t(grid.cells[0]) * size_t(grid.cells[1]) * size_t(grid.cells[2]));
  const auto cell_of = [&](int i, int j, int k) {
    const Vec3d low = grid.origin + edge * Vec3d{double(i), double(j), double(k)};
    return Cell{low - Vec3d{kGridRounding, kGridRounding, kGridRounding},
                low + Vec3d{edge + kGridRounding, edge + kGridRounding, edge + kGridRounding}};
  };
  const auto number = [&](int i, int j, int k) {
    return (size_t(k) * size_t(grid.cells[1]) + size_t(j)) * size_t(grid.cells[0]) + size_t(i);
  };
  for (int v = 0; v < skin.size(); ++v) {
    if (!skin.at_surface(v)) continue;
    const Vec3d p = vec_cast<double>(skin.rest[size_t(v)]);
    int from[3], to[3];
    for (int k = 0; k < 3; ++k) {
      from[k] = std::max(int((p[k] - grid.origin[k] - reach) / edge) - 1, 0);
      to[k] = std::min(int((p[k] - grid.origin[k] + reach) / edge) + 1, grid.cells[size_t(k)] - 1);
    }
    for (int k = from[2]; k <= to[2]; ++k)
      for (int j = from[1]; j <= to[1]; ++j)
        for (int i = from[0]; i <= to[0]; ++i)
          if (cell_of(i, j, k).nearest2(p) <= squared(reach + kGridRounding)) within[number(i, j, k)].push_back(v);
  }
  grid.first = {0};
  for (int k = 0; k < grid.cells[2]; ++k)
    for (int j = 0; j < grid.cells[1]; ++j)
      for (int i = 0; i < grid.cells[0]; ++i) {
        std::vector<std::int32_t>& some = within[number(i, j, k)];
        keep_candidates(skin, cell_of(i, j, k), some);
        grid.vertex.insert(grid.vertex.end(), some.begin(), some.end());
        grid.first.push_back(std::int32_t(grid.vertex.size()));
      }
  grid.filled.resize(within.size() / 64 + 1);
  for (size_t cell = 0; cell < within.size(); ++cell)
    if (grid.first[cell] < grid.first[cell + 1]) grid.filled[cell / 64] |= std::uint64_t(1) << (cell % 64);
  return grid;
}

}  // namespace trocar::interactions
