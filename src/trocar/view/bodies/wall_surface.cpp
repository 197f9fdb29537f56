#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/view/bodies/cavity.hpp>
#include <trocar/view/bodies/organ_drawing.hpp>
#include <trocar/view/bodies/wall_surface.hpp>

namespace trocar::view {
namespace {

constexpr float kWallCell = 0.008f;    // [m] about as long as an edge
constexpr float kWallFarthest = 1e3f;  // [m] all of it, from wherever

}  // namespace

WallSurface::WallSurface(const sim::Model& model) {
  const auto take = [this](std::span<const Vec3f> points, std::span<const Vec3f> normals,
                           std::span<const std::uint32_t> triangles) {
    const auto first = std::uint32_t(m_points.size());
    m_points.insert(m_points.end(), points.begin(), points.end());
    m_normals.insert(m_normals.end(), normals.begin(), normals.end());
    for (const std::uint32_t v : triangles) m_triangles.push_back(first + v);
  };
  for (const sim::WallModel& wall : model.walls) take(wall.skin.rest, wall.skin.rest_normal, flat_indices(wall.skin));
  m_cavity = cavity_around(model);
  if (!model.walls.empty()) take(m_cavity.positions, m_cavity.normals, m_cavity.indices);
  m_faces.resize(m_points.size());
  for (std::uint32_t t = 0; 3 * t < m_triangles.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) m_faces[m_triangles[3 * t + k]].push_back(t);
  std::vector<std::uint8_t> used;
  for (const std::vector<std::uint32_t>& faces : m_faces) used.push_back(faces.empty() ? 0 : 1);
  m_grid.emplace(m_points, kWallCell, used);
}

/// Ever wider around the place.
std::uint32_t WallSurface::nearest_vertex(Vec3f p) const {
  std::uint32_t best = 0;
  float least = 1e9f;
  for (float reach = m_grid->cell();; reach *= 3) {
    m_grid->visit(p, reach, [&](std::uint32_t i) {
      const Vec3f d = m_points[i] - p;
      const float d2 = dot(d, d);
      if (d2 > least || (d2 == least && i > best)) return;
      least = d2;
      best = i;
    });
    if (least <= reach * reach || reach > kWallFarthest) return best;
  }
}

/// The nearest vertex, then the nearest point of the triangles around it.
WallSurface::Place WallSurface::nearest(Vec3d p) const {
  if (!m_grid || m_grid->empty()) return {};
  const std::uint32_t best = nearest_vertex(vec_cast<float>(p));
  Place place{vec_cast<double>(m_points[best]), vec_cast<double>(m_normals[best]), true};
  double nearest = 1e9;
  for (const std::uint32_t t : m_faces[best]) {
    const std::uint32_t a = m_triangles[3 * t], b = m_triangles[3 * t + 1], c = m_triangles[3 * t + 2];
    const auto at = geometry::closest_on_triangle(p, vec_cast<double>(m_points[a]), vec_cast<double>(m_points[b]),
                                                  vec_cast<double>(m_points[c]));
    if (at.distance2 >= nearest) continue;
    nearest = at.distance2;
    place.point = at.point;
    place.normal = normalised(vec_cast<double>(float(at.weights.x) * m_normals[a] + float(at.weights.y) * m_normals[b] +
                                               float(at.weights.z) * m_normals[c]),
                              place.normal);
  }
  return place;
}

}  // namespace trocar::view
