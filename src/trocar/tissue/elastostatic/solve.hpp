// K u = f of all nodes by conjugate gradients, as the paper makes compliances: slow beside condense(), which it checks.
#pragma once

#include <span>
#include <vector>

#include <trocar/numerics/conjugate_gradient.hpp>
#include <trocar/tissue/elastostatic/stiffness.hpp>

namespace trocar::tissue {

class StiffnessSolver {
 public:
  /// The stiffness must outlive it. @throws NotHeld where a node has no stiffness
  explicit StiffnessSolver(const Stiffness& k);

  /// u = K^-1 f                                                                                      [KCM99 eq.6]
  /// @param force      (3 nodes), 0 on held axes [N]
  /// @param tolerance  of |f - K u| / |f|
  /// @param iterations  at most
  /// @return (3 nodes) displacements [m], or nothing where they were not found
  const std::vector<double>* solve(std::span<const double> force, double tolerance, int iterations);

 private:
  const Stiffness& m_k;
  std::vector<Mat3d> m_inverse;  ///< of the diagonal blocks, held axes left out
  std::vector<double> m_moved;
  numerics::ConjugateGradientWork m_work;
};

}  // namespace trocar::tissue
