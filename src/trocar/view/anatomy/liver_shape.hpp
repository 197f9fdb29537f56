// The shape of a liver beyond its simulated edge, at rest (liver_dome.hpp draws it): a height over the (x, y) plane
// that lies on the body's upper side where that still faces the front, and from there runs on, bending as little as it
// can.
#pragma once

#include <trocar/view/base/mesh_buffer.hpp>
#include <trocar/view/bodies/wall_surface.hpp>

namespace trocar::view {

class LiverShape {
 public:
  /// @param points, triangles the body's skin as drawn; its lower edge points to the feet (-y)
  LiverShape(std::span<const Vec3f> points, std::span<const std::uint32_t> triangles);

  /// What is drawn of it: the upper side, sunk into the body where they overlap, and a thin lower margin to both sides.
  /// It ends where a wall is.
  MeshBuffer dome(const WallSurface& wall) const;
  /// The falciform ligament from the dome to the wall; its free border is a round cord, which
  /// continues along the liver and sinks into it. Paint::tint: fat.
  MeshBuffer falciform(const WallSurface& wall) const;
  double height(double x, double y) const;  ///< of the upper side [m]

 private:
  /// A line from the lower edge towards the head.
  struct Column {
    double x = 0, low = 0, edge = 0;  ///< place of the lower edge: x, y, z [m]
    int join = 0;                     ///< rows below it are the body's own; 0: the body has ended
  };
  int rows() const { return int(m_z.size() / m_columns.size()); }
  std::size_t at(std::size_t column, int row) const { return column * std::size_t(rows()) + std::size_t(row); }
  double y_of(std::size_t column, int row) const;
  void scan(std::span<const Vec3f> points, std::span<const std::uint32_t> triangles);
  void find_join();
  void fair();
  double up_to_the_wall(std::size_t column, double begins, const WallSurface& wall) const;
  std::vector<int> depths() const;

  std::vector<Column> m_columns;
  std::size_t m_first = 0, m_last = 0;  ///< columns of the body
  std::vector<double> m_z;              ///< (columns x rows) [m]; while scanning NaN where the body is not
};

}  // namespace trocar::view
