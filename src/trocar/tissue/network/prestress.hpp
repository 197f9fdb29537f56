// Makes the drawn shape of a network its equilibrium under gravity, by choosing rest lengths.
//
// The linear network (springs in the drawn shape, [KCM99 eq.2] linearised) loaded by its weight yields displacements u
// with K u = f. The tension k (n . (u_b - u_a)) of each spring balances the weight exactly on the drawn shape; the law
// (5) is then inverted for the rest length that carries this tension at the drawn length. Anchors (springs from nodes
// to points in space) take part and get their rest points the same way. Our method; conjugate gradients in double.
//
//   PrestressReport report = prestress(description, anchors);
#pragma once

#include <span>

#include <trocar/core/fields.hpp>
#include <trocar/tissue/network/network.hpp>

namespace trocar::tissue {

/// A spring from a node to a point in space, isotropic: force k (x0 - x).
struct Anchor {
  int node = 0;
  double k = 0;       ///< [N/m]
  Vec3d x0{0, 0, 0};  ///< rest point [m]; written by prestress()

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("node", s.node), v("k", s.k), v("x0", s.x0);
  }
};

struct PrestressReport {
  bool converged = false;
  int iterations = 0;
  double residual = 0;        ///< largest unbalanced force on a free node, with the new rest lengths [N]
  double largest_strain = 0;  ///< largest |e/l| it put into a spring
  int failed_springs = 0;     ///< springs whose tension no rest length gives (left at the drawn length)
};

/// Rewrites the rest lengths of `network` (from its positions, gravity, masses, held axes) and the rest points of
/// `anchors`. A node that nothing holds makes the solve fail: converged = false and nothing is changed.
PrestressReport prestress(NetworkDescription& network, std::span<Anchor> anchors = {});

/// Largest unbalanced force on a free axis in the drawn shape at rest [N].
double largest_imbalance(const NetworkDescription& network, std::span<const Anchor> anchors = {});

}  // namespace trocar::tissue
