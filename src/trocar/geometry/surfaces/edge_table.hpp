// The edges of a triangle mesh that may be anything: which triangles use each of them, and which triangle lies across
// each side of a triangle. What examine() and the repairs are read from.
//
//   const EdgeTable edges(mesh);
//   edges.for_each([&](std::span<const EdgeUse> uses) { if (uses.size() > 2) ... });
//   const int other = edges.across(t, k);           // over the side from corner k to corner k + 1
//
// Triangles with a corner twice have no edges here.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry {

/// One side of a triangle.
struct EdgeUse {
  int low, high;  ///< the edge's vertices
  int triangle;
  signed char side;  ///< from corner `side` to the next
  bool upwards;      ///< from low to high
};

inline bool corner_twice(const std::array<int, 3>& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

class EdgeTable {
 public:
  explicit EdgeTable(const TriMesh& mesh);

  /// Calls f(span of uses) for every edge, in the order of vertices; uses in that of triangles.
  template <class F>
  void for_each(F&& f) const {
    for (std::size_t first = 0, last = 0; first < m_uses.size(); first = last) {
      while (last < m_uses.size() && same(m_uses[last], m_uses[first])) ++last;
      f(std::span<const EdgeUse>(m_uses.data() + first, last - first));
    }
  }

  static constexpr int kOpen = -1, kCrowded = -2;
  /// The triangle on the other side, kOpen where there is none, kCrowded where there is more than one. Triangles with a
  /// corner twice have kOpen all around.
  int across(int triangle, int side) const { return m_across[triangle][side]; }

 private:
  std::vector<EdgeUse> m_uses;
  std::vector<std::array<int, 3>> m_across;
  static bool same(const EdgeUse& a, const EdgeUse& b) { return a.low == b.low && a.high == b.high; }
};

/// Which corner of the triangle is this vertex; it is one of them.
inline int corner_of(const std::array<int, 3>& t, int vertex) { return t[0] == vertex ? 0 : (t[1] == vertex ? 1 : 2); }

}  // namespace trocar::geometry
