#include <algorithm>
#include <stdexcept>

#include <trocar/geometry/nurbs/closest.hpp>

namespace trocar::geometry::nurbs {
namespace {

constexpr double kCellMargin = 1.1;  // on the size of pieces as samples show it

// Ends of pieces of spans.
std::vector<double> piece_ends(const Knots& knots) {
  const std::vector<double> spans = breaks(knots);
  std::vector<double> ends;
  const int each = std::max(2, std::min(knots.degree + 1, 1 + 64 / static_cast<int>(spans.size())));
  for (std::size_t s = 0; s + 1 < spans.size(); ++s)
    for (int k = 0; k < each; ++k) ends.push_back(spans[s] + (spans[s + 1] - spans[s]) * k / each);
  ends.push_back(spans.back());
  return ends;
}

}  // namespace

ClosestOnSurface::ClosestOnSurface(const Surface& surface) : m_surface(surface) {
  require_valid(surface, "closest");
  const std::vector<double> us = piece_ends(surface.u), vs = piece_ends(surface.v);
  for (std::size_t j = 0; j + 1 < vs.size(); ++j)
    for (std::size_t i = 0; i + 1 < us.size(); ++i) {
      const double u = 0.5 * (us[i] + us[i + 1]), v = 0.5 * (vs[j] + vs[j + 1]);
      Cell cell{u, v, point(surface, u, v), 0.0};
      for (double a : {us[i], u, us[i + 1]})
        for (double b : {vs[j], v, vs[j + 1]})
          cell.radius = std::max(cell.radius, kCellMargin * length(point(surface, a, b) - cell.middle));
      m_cells.push_back(cell);
    }
}

SurfaceFoot ClosestOnSurface::find(Vec3d p) const {
  constexpr std::size_t kMostStarts = 16;
  if (!finite(p)) throw std::invalid_argument("closest: the point is not a number");
  std::vector<double> distance(m_cells.size());
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < m_cells.size(); ++i) {
    distance[i] = length(m_cells[i].middle - p);
    if (distance[i] < distance[nearest]) nearest = i;
  }
  SurfaceFoot best = closest_from(m_surface, p, m_cells[nearest].u, m_cells[nearest].v);
  std::vector<std::pair<double, std::size_t>> others;  // by how near they may come
  for (std::size_t i = 0; i < m_cells.size(); ++i) {
    const double at_least = distance[i] - m_cells[i].radius;
    if (i != nearest && at_least < best.distance) others.emplace_back(at_least, i);
  }
  const std::size_t most = std::min(others.size(), kMostStarts);
  std::partial_sort(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(most), others.end());
  for (std::size_t k = 0; k < most && others[k].first < best.distance; ++k) {
    const Cell& cell = m_cells[others[k].second];
    const SurfaceFoot foot = closest_from(m_surface, p, cell.u, cell.v);
    if (foot.distance < best.distance) best = foot;
  }
  return best;
}

SurfaceFoot closest(const Surface& surface, Vec3d p) { return ClosestOnSurface(surface).find(p); }

}  // namespace trocar::geometry::nurbs
