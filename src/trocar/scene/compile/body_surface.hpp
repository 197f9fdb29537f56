// The one surface that every shape of a body is: a loft through sections, another closed spline, triangles from a file.
// What fills a body, or makes a wall of it, asks for this and knows no shapes. Private to the folder.
//
//   const BodySurface shape = surface_of_body(solid);
//   const EvenSurface skin = shape.with_edges(solid.skin_edge);
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <trocar/geometry/curves/spline.hpp>
#include <trocar/geometry/surfaces/tri_mesh.hpp>
#include <trocar/geometry/volumes/lattice.hpp>
#include <trocar/scene/description/description.hpp>

namespace trocar::scene {

/// Closed, outwards, triangles all about alike.
struct EvenSurface {
  geometry::TriMesh mesh;
  std::vector<double> along;  ///< how far along the body each vertex is [m]; empty where that says nothing
  std::vector<std::array<double, 2>> parameters;  ///< (u, v) of each vertex where it is a spline; else empty
};

class BodySurface {
 public:
  /// Around in u, poles at both ends of v. @param way  from the first end to the last [m]
  BodySurface(geometry::NurbsSurface spline, double way, double apart);
  /// Any closed one. @param line  samples of what it runs along; empty: nothing
  BodySurface(geometry::TriMesh mesh, std::vector<Vec3d> line, double apart);

  /// With edges of about `edge` [m]: smaller where it is too thin for that.
  /// @throws std::invalid_argument where it cannot be made of triangles
  EvenSurface with_edges(double edge) const;
  /// As finely as it was given, or with edges of about `edge` where it is a spline.
  geometry::TriMesh as_given(double edge) const;
  /// Parts whose ways along the body differ by more do not hang together [m].
  double apart() const { return m_apart; }

 private:
  std::optional<geometry::NurbsSurface> m_spline;
  geometry::TriMesh m_mesh;
  std::vector<Vec3d> m_line;
  double m_way = 0, m_apart = geometry::Lattice::kNoMatterHowFar;

  std::vector<double> ways_of(const std::vector<Vec3d>& points) const;
};

/// A mesh with its vertices in another order, and its triangles by the lowest of theirs.
/// @param order  the number that each vertex has had
geometry::TriMesh in_order(const geometry::TriMesh& mesh, const std::vector<int>& order);
/// Of a body with its vertices along a Morton curve, so that blocks of neighbours in memory are compact in space.
EvenSurface skin_surface(const BodySurface& shape, double edge);

/// @throws std::invalid_argument where the shape is none
BodySurface surface_of_body(const Solid& solid);
BodySurface surface_of_body(const Pouch& pouch);

}  // namespace trocar::scene
