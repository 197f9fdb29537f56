// Triangle meshes as two plain arrays, and what is asked of them while a scene compiles: normals, area, volume, whether
// the surface is closed, neighbours. Files of them: surface_files/surface_file.hpp.
//
//   const TriMesh mesh = joined(read_surface_file("organ.obj"));
//   if (!check_edges(mesh).closed()) ...
//   const Csr neighbours = vertex_neighbours(mesh);
//   for (int other : neighbours.row(vertex)) ...
//
// Triangles run counter-clockwise seen from outside. Lengths in metres.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry {

struct TriMesh {
  std::vector<Vec3d> positions;
  std::vector<std::array<int, 3>> triangles;
};

/// Twice the area times the unit normal of triangle t.
Vec3d area_vector(const TriMesh& mesh, int t);
/// Unit normals (0,0,0 for a vertex without triangles or of degenerate ones): the triangles' normals weighted so that a
/// mesh inscribed in a sphere gets the sphere's normals exactly. [Max 1999, Weights for computing vertex normals]
std::vector<Vec3d> vertex_normals(const TriMesh& mesh);
double area(const TriMesh& mesh);
/// The smallest angle of triangle t [degrees].
double least_angle_deg(const TriMesh& mesh, int t);
/// Enclosed volume (closed meshes): positive where triangles face outwards.
double volume(const TriMesh& mesh);
/// Centre of the enclosed volume (closed meshes).
Vec3d centre_of_volume(const TriMesh& mesh);

struct Bounds {
  Vec3d low, high;
};
/// The box around all points; low > high where there are none.
Bounds bounds(std::span<const Vec3d> points);

/// How the edges are shared.
struct EdgeReport {
  int edges = 0;         ///< different edges
  int open = 0;          ///< with one triangle
  int crowded = 0;       ///< with more than two
  int inconsistent = 0;  ///< with two that run along it the same way: one of them is turned inside out
  bool closed() const { return edges > 0 && open == 0 && crowded == 0 && inconsistent == 0; }
};
EdgeReport check_edges(const TriMesh& mesh);
/// Every edge once, as (lower, higher) vertex, in lexicographic order.
std::vector<std::array<int, 2>> edges(const TriMesh& mesh);

/// Rows of varying length in two arrays.
struct Csr {
  std::vector<int> start;  ///< rows + 1
  std::vector<int> items;
  int rows() const { return static_cast<int>(start.size()) - 1; }
  std::span<const int> row(int i) const {
    return {items.data() + start[i], static_cast<std::size_t>(start[i + 1] - start[i])};
  }
};
/// For each vertex the vertices that share an edge with it, ascending.
Csr vertex_neighbours(const TriMesh& mesh);
/// For each vertex the triangles that use it, ascending.
Csr vertex_triangles(const TriMesh& mesh);

/// Puts the second mesh behind the first.
void append(TriMesh& mesh, const TriMesh& other);

/// Vertices closer than `distance` in every coordinate's rounded grid become one; degenerate triangles go.
/// For meshes from files that repeat the vertices of seams.
TriMesh merged_vertices(const TriMesh& mesh, double distance);

}  // namespace trocar::geometry
