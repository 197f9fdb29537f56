// The equations of a chain of nodes some of which touch each other: symmetric, positive definite, blocks of 3 x 3. The
// chain couples each node with the next two; contact couples nodes that may lie anywhere. Nodes without contact are
// eliminated along the chain, run by run; those with contact make up the front, whose order is chosen so that little
// fills up (minimum degree, ties to the lower node). Nothing is pivoted, and the order of every sum is fixed.
//
//   system.open();                                   // which nodes touch:
//   system.couple(nodes, 4);  ...                    //   each contact, by its nodes
//   system.arrange();
//   system.add(i, j, c, block); system.push(i, f);   // the lower half: i >= j
//   if (system.factor() < 0) system.solve();         // then system.unknown(i)
#pragma once

#include <cstdint>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::suture {

/// Symmetric 3x3.
struct Symmetric {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  Vec3d operator*(Vec3d v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
};
/// a n n^T + b (1 - n n^T)
inline Symmetric along_and_across(double a, double b, Vec3d n) {
  const double k = a - b;
  return {b + k * n.x * n.x, b + k * n.y * n.y, b + k * n.z * n.z, k * n.x * n.y, k * n.x * n.z, k * n.y * n.z};
}
inline Symmetric in_all_ways(double k) { return {k, k, k, 0, 0, 0}; }
inline Symmetric operator+(Symmetric a, Symmetric b) {
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
}

/// Column by column, each filled up to four numbers and aligned for a move of all four: compilers may choose one that
/// faults where it is not.
struct alignas(32) Block {
  double c[3][4];
};

class BlockSystem {
 public:
  BlockSystem() : BlockSystem(0) {}
  explicit BlockSystem(int nodes);

  void open() noexcept;
  /// These nodes (ascending) are coupled with each other.
  void couple(const std::int32_t* nodes, int count) noexcept;
  /// Chooses the order and empties the equations.
  void arrange() noexcept;

  void add(int i, int j, double c, const Symmetric& s) noexcept;  ///< c s to block (i, j), i >= j
  void push(int i, Vec3d f) noexcept { m_rhs[std::size_t(i)] += f; }
  /// s to a node, its neighbours' difference: weights 1, -2, 1 of i - 1, i, i + 1.
  void add_bend(int i, const Symmetric& s) noexcept;
  /// A term of `count` nodes in ascending order, with weights c.
  void add_term(const std::int32_t* nodes, const double* c, int count, const Symmetric& s) noexcept;

  /// -1, or the first node whose pivot is not positive.
  int factor() noexcept;
  void solve() noexcept;
  Vec3d unknown(int i) const noexcept { return m_rhs[std::size_t(i)]; }
  bool touches(int node) const noexcept { return m_place[std::size_t(node)] >= 0; }
  int coupled() const noexcept { return m_count; }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("nodes", s.m_nodes, core::kMadeOnce), v("words", s.m_words, core::kMadeOnce), v("count", s.m_count),
        v("diagonal", s.m_diagonal), v("next", s.m_next), v("second", s.m_second), v("left1", s.m_left1),
        v("left2", s.m_left2), v("front", s.m_front), v("place", s.m_place), v("at", s.m_at), v("first", s.m_first),
        v("rows", s.m_rows), v("touch", s.m_touch), v("linked", s.m_linked), v("degree", s.m_degree), v("rhs", s.m_rhs);
  }

 private:
  std::size_t in_front(int row, int column) const noexcept {  // of places, row >= column
    return std::size_t(column) * std::size_t(m_count) - std::size_t(column) * std::size_t(column + 1) / 2 +
           std::size_t(row);
  }
  void link(int i, int j) noexcept;
  void to_front() noexcept;
  int run_forward(int first, int last, bool bordered) noexcept;
  int run_backward(int first, int last) noexcept;
  int factor_front() noexcept;

  int m_nodes = 0, m_words = 0, m_count = 0;
  std::vector<Block> m_diagonal, m_next, m_second;  ///< (n) blocks (i, i), (i + 1, i), (i + 2, i)
  std::vector<Block> m_left1, m_left2;              ///< (n) of a run's node with the two nodes before its run
  std::vector<Block> m_front;                       ///< lower half, column by column of places
  std::vector<std::int32_t> m_place;                ///< (n) in the front, or -1
  std::vector<std::int32_t> m_at;                   ///< node at a place
  std::vector<std::int32_t> m_first, m_rows;        ///< rows below the diagonal of a column of the front
  std::vector<std::int32_t> m_touch;                ///< (n) 1 = in the front
  std::vector<std::uint64_t> m_linked;              ///< (n x words) which nodes of the front are coupled
  std::vector<std::int32_t> m_degree;
  std::vector<Vec3d> m_rhs;
};

}  // namespace trocar::suture
