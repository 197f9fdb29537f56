#include <trocar/tissue/elastostatic/condense.hpp>
#include <trocar/tissue/elastostatic/solve.hpp>

namespace trocar::tissue {

Condensed condense_by_unit_forces(const Stiffness& k, std::span<const int> kept) {
  const int unknowns = 3 * k.nodes();
  const std::size_t n = 3 * kept.size();
  Condensed out{int(kept.size()), std::vector<double>(n * n, 0.0), {}};
  StiffnessSolver solver(k);
  std::vector<double> force(std::size_t(unknowns), 0.0);
  for (std::size_t j = 0; j < n; ++j) {
    const int node = kept[j / 3], axis = int(j % 3);
    if (k.held[std::size_t(node)] >> axis & 1) continue;
    double& unit = force[std::size_t(3 * node + axis)];
    unit = 1;
    const std::vector<double>* moved = solver.solve(force, 1e-12, 20 * unknowns + 100);
    if (!moved) refuse_unheld(node);
    unit = 0;
    for (std::size_t i = 0; i < n; ++i) out.compliance[j * n + i] = (*moved)[std::size_t(kept[i / 3]) * 3 + i % 3];
  }
  return out;
}

}  // namespace trocar::tissue
