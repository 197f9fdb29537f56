// A triangle mesh that is changed edge by edge: edges collapse, are split and flipped, and it stays the manifold that
// it was. What remeshing, thinning out and patching are made of.
//
//   EditableMesh work(mesh);
//   if (work.can_collapse(a, b)) work.collapse(a, b);      // a goes, its triangles take b
//   const int middle = work.split(a, b, place);
//   return work.taken();
//
// Vertices and faces keep their numbers; new ones come last, dead ones have no faces, or are not alive. Shapes are the
// caller's business: what is allowed here may still fold the surface.
#pragma once

#include <array>
#include <vector>

#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry {

class EditableMesh {
 public:
  /// Triangles with a corner twice are left out.
  explicit EditableMesh(const TriMesh& mesh);

  /// The faces that are alive, and the vertices that they have, in their order.
  TriMesh taken() const;

  int vertices() const { return int(m_places.size()); }
  int faces() const { return int(m_faces.size()); }
  int living_faces() const { return m_living; }
  bool alive(int face) const { return m_alive[face]; }
  const std::array<int, 3>& face(int f) const { return m_faces[f]; }
  const std::vector<int>& faces_at(int vertex) const { return m_faces_at[vertex]; }
  Vec3d place(int vertex) const { return m_places[vertex]; }
  void move(int vertex, Vec3d to) { m_places[vertex] = to; }
  /// Twice the area times the unit normal.
  Vec3d area_vector(int face) const;

  /// The faces at an edge: up to two of them, and how many there are.
  struct Sides {
    std::array<int, 2> face{-1, -1};
    int count = 0;
  };
  Sides sides(int a, int b) const;
  /// The corner of a face that is not at this edge.
  int opposite(int face, int a, int b) const;
  /// Each once, in the order of faces.
  void neighbours(int vertex, std::vector<int>& out) const;
  bool on_border(int vertex) const;  ///< at an edge that has not two faces

  /// Whether the surface stays a manifold of the same kind. [link condition: Dey et al. 1999]
  bool can_collapse(int from, int into) const;
  void collapse(int from, int into);
  /// A new vertex on the edge; each face there becomes two.
  int split(int a, int b, Vec3d at);
  /// A new vertex within the face, which becomes three.
  int split_face(int face, Vec3d at);
  /// Whether the edge's two faces can have the other diagonal.
  bool can_flip(int a, int b) const;
  /// The edge's other diagonal takes its place.
  void flip(int a, int b);
  void kill(int face);
  int add_face(const std::array<int, 3>& corners);
  int add_vertex(Vec3d place);

 private:
  std::vector<Vec3d> m_places;
  std::vector<std::array<int, 3>> m_faces;
  std::vector<bool> m_alive;
  std::vector<std::vector<int>> m_faces_at;
  int m_living = 0;

  void set_face(int face, const std::array<int, 3>& corners);
};

}  // namespace trocar::geometry
