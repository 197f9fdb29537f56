#include <trocar/numerics/conjugate_gradient.hpp>
#include <trocar/tissue/elastostatic/condense.hpp>

namespace trocar::tissue {
namespace {

/// Inverses of the diagonal blocks, held axes left out.
std::vector<Mat3d> inverse_diagonal(const Stiffness& k) {
  std::vector<Mat3d> out;
  for (int node = 0; node < k.nodes(); ++node) {
    Mat3d block = k.block[std::size_t(k.first[std::size_t(node) + 1] - 1)];
    for (int axis = 0; axis < 3; ++axis)
      if (k.held[std::size_t(node)] >> axis & 1) {
        for (int i = 0; i < 3; ++i) block.m[i][axis] = block.m[axis][i] = 0;
        block.m[axis][axis] = 1;
      }
    if (!(determinant(block) > 0)) refuse_unheld(node);
    out.push_back(inverse(block));
  }
  return out;
}

}  // namespace

Condensed condense_by_unit_forces(const Stiffness& k, std::span<const int> kept) {
  const int unknowns = 3 * k.nodes();
  const std::size_t n = 3 * kept.size();
  Condensed out{int(kept.size()), std::vector<double>(n * n, 0.0), {}};
  const std::vector<Mat3d> blocks = inverse_diagonal(k);
  numerics::ConjugateGradientWork work(unknowns);
  std::vector<double> force(std::size_t(unknowns), 0.0), moved(std::size_t(unknowns), 0.0);
  for (std::size_t j = 0; j < n; ++j) {
    const int node = kept[j / 3], axis = int(j % 3);
    if (k.held[std::size_t(node)] >> axis & 1) continue;
    force[std::size_t(3 * node + axis)] = 1;
    moved.assign(std::size_t(unknowns), 0.0);
    const auto done = numerics::conjugate_gradient([&](const double* x, double* y) { multiply(k, x, y); },
                                                   numerics::BlockPreconditioner{blocks.data()}, force.data(),
                                                   moved.data(), unknowns, {20 * unknowns + 100, 1e-12}, work);
    if (!done.converged) refuse_unheld(node);
    force[std::size_t(3 * node + axis)] = 0;
    for (std::size_t i = 0; i < n; ++i) out.compliance[j * n + i] = moved[std::size_t(kept[i / 3]) * 3 + i % 3];
  }
  return out;
}

}  // namespace trocar::tissue
