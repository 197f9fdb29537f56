#include <cmath>

#include <trocar/geometry/surfaces/point_grid.hpp>

namespace trocar::geometry {
namespace {

constexpr double kMostCells = 1 << 20;

}  // namespace

PointGrid::PointGrid(std::span<const Vec3f> points, float cell, std::span<const std::uint8_t> taken) : m_cell(cell) {
  const auto counts = [&](std::size_t i) { return taken.empty() || taken[i] != 0; };
  Vec3f low{1e9f, 1e9f, 1e9f}, high{-1e9f, -1e9f, -1e9f};
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int a = 0; counts(i) && a < 3; ++a) {
      low[a] = std::min(low[a], points[i][a]);
      high[a] = std::max(high[a], points[i][a]);
    }
  if (low.x > high.x) return;
  m_low = low;
  const auto cells = [&](int a) { return std::floor(double(high[a] - low[a]) / double(m_cell)) + 1; };
  while (cells(0) * cells(1) * cells(2) > kMostCells) m_cell *= 1.5f;
  for (int a = 0; a < 3; ++a) m_size[std::size_t(a)] = int(cells(a));
  const auto cell_of = [&](Vec3f p) {
    return std::size_t((along(p.z, 2) * m_size[1] + along(p.y, 1)) * m_size[0] + along(p.x, 0));
  };
  m_start.assign(std::size_t(m_size[0]) * std::size_t(m_size[1]) * std::size_t(m_size[2]) + 1, 0);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (counts(i)) ++m_start[cell_of(points[i]) + 1];
  for (std::size_t c = 1; c < m_start.size(); ++c) m_start[c] += m_start[c - 1];
  std::vector<std::uint32_t> next(m_start.begin(), m_start.end() - 1);
  m_number.resize(m_start.back());
  for (std::size_t i = 0; i < points.size(); ++i)
    if (counts(i)) m_number[next[cell_of(points[i])]++] = std::uint32_t(i);
}

int PointGrid::along(float x, int axis) const {
  const float place = std::floor((x - m_low[axis]) / m_cell);
  return int(std::clamp(place, 0.0f, float(m_size[std::size_t(axis)] - 1)));
}

PointGrid::Cells PointGrid::cells_around(Vec3f p, float reach) const {
  if (empty()) return {};
  Cells cells;
  for (int a = 0; a < 3; ++a) {
    cells.low[std::size_t(a)] = along(p[a] - reach, a);
    cells.high[std::size_t(a)] = along(p[a] + reach, a);
  }
  return cells;
}

}  // namespace trocar::geometry
