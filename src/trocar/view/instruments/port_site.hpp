// The peritoneum round a trocar: drawn up along the sleeve like a tent, with a slit whose rim is red. Drawn only: it
// follows the sleeve, the simulation's wall stays where it is.
//
//   PortSite site(port, axis, sleeve_radius, walls, backend);
//   site.update(axis);                                   // where the sleeve points now
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <trocar/view/base/level_of_detail.hpp>
#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

/// A surface that a trocar may come through.
struct PiercedWall {
  std::span<const Vec3f> positions, normals;  ///< normals may be empty
  std::span<const std::uint32_t> indices;
  std::string look;
};

/// Where a line crosses the walls.
struct Crossing {
  double at = 0;  ///< along the line [m]
  Vec3d point, normal;
  std::size_t wall = 0;
};
/// The crossing that lies farthest along unit `direction` between `from` and `to` [m].
std::optional<Crossing> last_crossing(std::span<const PiercedWall> walls, Vec3d origin, Vec3d direction, double from,
                                      double to);

class PortSite {
 public:
  /// @param axis of the sleeve, into the body @param radius of the sleeve, outside [m]
  /// Nothing is drawn where the line crosses no wall near the port.
  PortSite(Vec3d port, Vec3d axis, double radius, std::span<const PiercedWall> walls, render::Backend& backend,
           const Detail& detail = {});

  void update(Vec3d axis);
  render::MeshHandle mesh() const { return m_mesh.handle(); }
  const std::string& look() const { return m_look; }
  const MeshBuffer& buffer() const { return m_shape; }
  /// From the port to the wall along the first axis; negative: behind the port [m].
  double depth() const { return m_depth; }

 private:
  void shape(Vec3d axis);
  double wall_height(int side, double away) const;

  Vec3d m_port, m_axis, m_centre, m_normal, m_u, m_v;  ///< port, sleeve, hole in the wall and the wall's plane
  double m_radius = 0, m_depth = 0;
  std::vector<Vec3d> m_base;  ///< (rows x sides) on the wall at rest
  std::vector<Vec3f> m_wall_normal;
  std::string m_look = "peritoneum";
  MeshBuffer m_shape;
  OwnedMesh m_mesh;
};

}  // namespace trocar::view
