#include <trocar/tissue/elastostatic/condense.hpp>
#include <trocar/tissue/elastostatic/solve.hpp>

namespace trocar::tissue {

StiffnessSolver::StiffnessSolver(const Stiffness& k) : m_k(k), m_work(3 * k.nodes()) {
  for (int node = 0; node < k.nodes(); ++node) {
    Mat3d block = k.block[std::size_t(k.first[std::size_t(node) + 1] - 1)];
    for (int axis = 0; axis < 3; ++axis)
      if (k.held[std::size_t(node)] >> axis & 1) {
        for (int i = 0; i < 3; ++i) block.m[i][axis] = block.m[axis][i] = 0;
        block.m[axis][axis] = 1;
      }
    if (!(determinant(block) > 0)) refuse_unheld(node);
    m_inverse.push_back(inverse(block));
  }
}

const std::vector<double>* StiffnessSolver::solve(std::span<const double> force, double tolerance, int iterations) {
  const int unknowns = 3 * m_k.nodes();
  m_moved.assign(std::size_t(unknowns), 0.0);
  const auto done = numerics::conjugate_gradient([&](const double* x, double* y) { multiply(m_k, x, y); },
                                                 numerics::BlockPreconditioner{m_inverse.data()}, force.data(),
                                                 m_moved.data(), unknowns, {iterations, tolerance}, m_work);
  return done.converged ? &m_moved : nullptr;
}

}  // namespace trocar::tissue
