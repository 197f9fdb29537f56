// A surface that others touch: the posed skin of an organ, or a wall that never moves. Depth queries go to the nearest
// vertex, found by walking downhill over the mesh from where it was last tick (that index is State).
#pragma once

#include <trocar/core/fields.hpp>
#include <trocar/tissue/network/skin.hpp>

namespace trocar::interactions {

/// A surface as it is now. A wall has no nodes.
struct Surface {
  const tissue::Skin* skin = nullptr;
  const tissue::SkinPose* pose = nullptr;
  tissue::NodeView nodes;
  float torn_beyond = 0;  ///< [m]; 0: its skin never tears
  bool swings = false;  ///< what it encloses kicks its nodes when a tick begins, and they have swung back when it ends

  bool moves() const noexcept { return !nodes.empty(); }
  Vec3d position(int vertex) const noexcept { return vec_cast<double>(pose->position[size_t(vertex)]); }
  Vec3d normal(int vertex) const noexcept;
  Vec3d velocity(int vertex) const noexcept;  ///< of a wall: none
  /// Is nothing there any more? Where a lattice tears, what carries a vertex goes apart and takes it along in between.
  bool torn(int vertex) const noexcept;
  /// The same for the edge between two neighbours.
  bool torn(int vertex, int neighbour) const noexcept;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("skin", s.skin), v("pose", s.pose), v("nodes", s.nodes), v("torn_beyond", s.torn_beyond), v("swings", s.swings);
  }
};

/// Of a lattice: a vertex is torn off where one of its carriers is further away than five times the cells' diagonal.
float torn_beyond(double cell) noexcept;

/// Does the segment come nearer to the box than `margin`? Never false where it does; the box is grown by its faces, so
/// that near its corners it may be true without.
bool meets_box(const tissue::Box& box, Vec3d a, Vec3d b, double margin) noexcept;

/// The vertex nearest to p, reached from `start` by steps to nearer neighbours (a local minimum; at most 64 steps).
int walk_to_nearest(const Surface& surface, int start, Vec3d p) noexcept;

/// The nearest of all vertices (for compile and first contact).
int nearest_vertex(const Surface& surface, Vec3d p) noexcept;

/// Signed distance of p above the surface near `vertex` (negative inside) and the outward normal there.
struct Clearance {
  double distance = 0;
  Vec3d normal{0, 0, 1};
};
Clearance clearance_at(const Surface& surface, int vertex, Vec3d p) noexcept;

/// The same above the nearest of those triangles at `vertex` that face p, where a surface with normal `facing` lies;
/// far above where there is none. For sharp rims, where a vertex' own plane leans outwards so that bodies catch or sink
/// in.
Clearance facing_clearance(const Surface& surface, int vertex, Vec3d p, Vec3d facing) noexcept;

}  // namespace trocar::interactions
