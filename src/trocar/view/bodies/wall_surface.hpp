// Everything that a scene's peritoneum is drawn as, as one surface: its walls and what leads from their borders to the
// cavity. For what is drawn only and has to end on it.
#pragma once

#include <optional>
#include <vector>

#include <trocar/geometry/surfaces/point_grid.hpp>
#include <trocar/sim/model/model.hpp>
#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

class WallSurface {
 public:
  explicit WallSurface(const sim::Model& model);

  struct Place {
    Vec3d point, normal;  ///< [m]; unit, into the cavity
    bool there = false;   ///< false: the scene has no walls
  };
  Place nearest(Vec3d p) const;
  const MeshBuffer& cavity() const { return m_cavity; }  ///< what continues from the walls' borders

 private:
  std::uint32_t nearest_vertex(Vec3f p) const;

  MeshBuffer m_cavity;
  std::vector<Vec3f> m_points, m_normals;
  std::vector<std::uint32_t> m_triangles;
  std::vector<std::vector<std::uint32_t>> m_faces;  ///< (points) their triangles
  std::optional<geometry::PointGrid> m_grid;        ///< of the points that have triangles
};

}  // namespace trocar::view
