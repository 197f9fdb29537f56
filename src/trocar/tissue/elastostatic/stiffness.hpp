// The stiffness matrix K of an organ at its drawn shape, K u = f                                          [KCM99 eq.6]
//
// Of the organ's own spring network, linearised where it is drawn, so that the static solver and the dynamic one have
// one material: the tangent of each spring's law along it, and across it the tension that gravity puts into it; the
// springs that hang it in space; the volume force of organs with a Poisson's ratio above 1/4. Or of linear tetrahedra.
//
//   StiffnessBuilder builder(points, held);
//   builder.add_springs(springs);
//   builder.add_anchors(anchors);
//   const Stiffness k = builder.build();
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <trocar/numerics/mat3.hpp>
#include <trocar/tissue/network/network.hpp>
#include <trocar/tissue/network/prestress.hpp>

namespace trocar::tissue {

/// Symmetric, in blocks of 3x3 by nodes. Only what stands at or left of the diagonal is kept.
struct Stiffness {
  std::vector<Vec3d> points;       ///< (n) drawn [m]
  std::vector<std::uint8_t> held;  ///< (n) Held bits: rows and columns of held axes are left out of all products
  std::vector<int> first;          ///< (n + 1) into column and block
  std::vector<int> column;         ///< ascending in a row, the diagonal last
  std::vector<Mat3d> block;        ///< [N/m]

  int nodes() const noexcept { return int(points.size()); }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("points", s.points), v("held", s.held), v("first", s.first), v("column", s.column), v("block", s.block);
  }
};

/// Collects blocks in any order; the sum of those of one place is made in the order in which they came.
class StiffnessBuilder {
 public:
  /// @param held  (n) Held bits, or empty: all free
  StiffnessBuilder(std::span<const Vec3d> points, std::span<const std::uint8_t> held);

  /// The tangent of springs as they are drawn: k s'(eps) along, tension over length across, the push of those that are
  /// pressed together (negative) as well: the dynamic network has it, and without it blocks that stand under their own
  /// weight come out up to ten times too stiff sideways. What buckles so has a K that is not positive (NotHeld).
  /// @throws std::out_of_range for nodes that are not there
  void add_springs(std::span<const SpringDescription> springs);
  /// Isotropic springs to space.
  void add_anchors(std::span<const Anchor> anchors);
  /// kappa / V_a  g_a g_a^T of each node a, with g_a what its volume V_a is changed by (volume_force.hpp).
  void add_volume(std::span<const std::array<int, 4>> cells, double kappa);
  /// Linear tetrahedra of Young's modulus E [Pa] and Poisson's ratio nu (0 to 0.45), along `fibre` (unit, or zero)
  /// stiffer by `fibre_ratio` (>= 1). @throws std::invalid_argument for a cell without volume
  void add_tetrahedra(std::span<const std::array<int, 4>> cells, double young, double poisson, Vec3d fibre = {},
                      double fibre_ratio = 1);

  Stiffness build() const;

 private:
  struct Entry {
    int row, column;
    Mat3d block;
  };
  void add(int row, int column, const Mat3d& block);

  std::vector<Vec3d> m_points;
  std::vector<std::uint8_t> m_held;
  std::vector<Entry> m_entries;
};

/// y = K x on free axes, 0 on held ones. (3 n)
void multiply(const Stiffness& k, const double* x, double* y) noexcept;

}  // namespace trocar::tissue
