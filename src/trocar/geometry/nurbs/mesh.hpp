// Triangle meshes of NURBS surfaces, for drawing and for other uses of triangles: watertight where the surface closes,
// as seams are one row of vertices and poles one vertex with a fan around it.
//
//   SurfaceMesh mesh = tessellate(surface, Steps{4, 4});            // four steps to a span of knots
//   mesh = tessellate(surface, 0.0002);                             // no chord further off than 0.2 mm
//   MovingMesh moving(surface, mesh);                               // the same triangles, control points moved
//
// Triangles run counter-clockwise seen from where du x dv points; of closed surfaces, seen from outside. A vertex on an
// edge of the surface has the normal of the side that the greater parameters are on.
#pragma once

#include <array>
#include <vector>

#include <trocar/geometry/nurbs/grid.hpp>
#include <trocar/geometry/nurbs/surface.hpp>
#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry::nurbs {

/// Steps to a span of knots, so that every knot, and with it every edge of the surface, is on a row of vertices.
struct Steps {
  int u = 4, v = 4;
};

struct SurfaceMesh {
  TriMesh mesh;
  std::vector<Vec3d> normals;                     ///< of the surface, unit, outwards where it is closed
  std::vector<std::array<double, 2>> parameters;  ///< (u, v) of each vertex; the u of poles is 0
  // How vertices stand in the grid of parameters that was evaluated.
  std::vector<double> us, vs;
  std::vector<int> grid_point;  ///< of each vertex: (i, j) at i + us.size() j
  bool turned = false;          ///< normals are against du x dv
};

/// @throws std::invalid_argument for a faulty surface or steps below 1 (2 around a closed direction of a single span)
SurfaceMesh tessellate(const Surface& surface, Steps steps);
/// The same at given ascending parameters, ends of clamped directions included, the end of closed ones left out or not.
SurfaceMesh tessellate(const Surface& surface, std::vector<double> us, std::vector<double> vs);
/// So fine that along u, along v and across the diagonals the surface is nowhere further than `tolerance` [m] from the
/// triangles, as looked at in the middle of each edge.
SurfaceMesh tessellate(const Surface& surface, double tolerance);

/// Moves a tessellation with its surface's control points, without allocation.
class MovingMesh {
 public:
  MovingMesh(const Surface& surface, const SurfaceMesh& mesh);
  /// @param positions, normals out: of the mesh's vertices
  void move(std::span<const Vec3d> points, std::span<Vec3d> positions, std::span<Vec3d> normals) noexcept;

 private:
  GridEvaluator m_grid;
  std::vector<int> m_grid_point;
  double m_sign;
  std::vector<Vec3d> m_positions, m_normals;  ///< of the whole grid
};

}  // namespace trocar::geometry::nurbs
