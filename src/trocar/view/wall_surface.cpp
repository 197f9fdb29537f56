#include <trocar/geometry/nearest.hpp>
#include <trocar/view/cavity.hpp>
#include <trocar/view/organ_drawing.hpp>
#include <trocar/view/wall_surface.hpp>

namespace trocar::view {

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
}

/// The nearest vertex, then the nearest point of the triangles around it.
WallSurface::Place WallSurface::nearest(Vec3d p) const {
  if (m_points.empty()) return {};
  const Vec3f q = vec_cast<float>(p);
  std::size_t best = 0;
  float least = 1e9f;
  for (std::size_t i = 0; i < m_points.size(); ++i) {
    const Vec3f d = m_points[i] - q;
    if (const float d2 = dot(d, d); d2 < least && !m_faces[i].empty()) {
      least = d2;
      best = i;
    }
  }
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
