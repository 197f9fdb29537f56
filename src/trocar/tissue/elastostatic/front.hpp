// One step of multifrontal elimination [Duff & Reid 1983]: the dense matrix of the nodes that are eliminated together
// and of their border, assembled from K and from what the steps below have left.
//
// Unknowns stand in the order: own (3 a node), filled up to eights; border, filled up; loads, filled up. Loads are rows
// only, never pivots: below a pivot stands the force on it.
#pragma once

#include <span>
#include <vector>

#include <trocar/tissue/elastostatic/dense.hpp>
#include <trocar/tissue/elastostatic/dissection.hpp>

namespace trocar::tissue {

/// Sizes of a front [unknowns].
struct FrontSize {
  int pivots, border, loads;
  FrontSize(const FrontNodes& nodes, int load_count);
  int rest() const noexcept { return border + loads; }
  int rows() const noexcept { return pivots + rest(); }
  double eliminated() const noexcept { return double(pivots) * rows() * rows(); }  ///< about as many products
};

/// What goes into fronts: K, by the node that is eliminated first, and forces.
class FrontSource {
 public:
  /// @param loads  (count x 3 nodes)
  FrontSource(const Stiffness& k, const Dissection& order, std::span<const double> loads);

  /// What is left of a front when its own nodes are eliminated (rest x rest), and of its children nothing.
  /// @param left  (fronts) of those below
  /// @throws NotHeld
  void eliminate_front(int front, std::vector<AlignedNumbers>& left, core::ThreadPool* pool);

  FrontSize size(int front) const { return {m_order.fronts[std::size_t(front)], m_loads}; }
  /// K's diagonal, 1 on held axes.
  double diagonal(int node, int axis) const;

 private:
  struct Matrix;
  void give_places(const FrontNodes& nodes, const FrontSize& size);
  void add_entries(int node, const Matrix& to) const;
  void add_loads(int node, const Matrix& to, const FrontSize& size) const;
  void add_child(int child, const FrontSize& size, double* left, const Matrix& to);

  const Stiffness& m_k;
  const Dissection& m_order;
  std::span<const double> m_forces;
  int m_loads;
  std::vector<int> m_row_of;          ///< (entries) nodes
  std::vector<int> m_first, m_entry;  ///< (nodes + 1), (entries) by the node that goes first
  std::vector<int> m_local;           ///< (nodes) in the front at hand
  std::vector<int> m_to;              ///< where a child's unknowns go
  std::vector<double> m_original;     ///< (pivots)
};

/// The most that fronts and what they leave take at once [B].
double memory_of(const Dissection& order, int loads);

}  // namespace trocar::tissue
