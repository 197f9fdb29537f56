// Organs for tests of the elastostatic solver.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <trocar/core/random.hpp>
#include <trocar/tissue/elastostatic/condense.hpp>
#include <trocar/tissue/network/lattice_springs.hpp>

#include "test_bodies.hpp"

namespace trocar::tissue::test {

struct Organ {
  Stiffness k;
  std::vector<int> kept;
};

/// Nodes of a box of (nx + 1) (ny + 1) (nz + 1) that lie on its faces.
inline std::vector<int> surface_of_box(int nx, int ny, int nz) {
  std::vector<int> out;
  for (int z = 0; z <= nz; ++z)
    for (int y = 0; y <= ny; ++y)
      for (int x = 0; x <= nx; ++x)
        if (x == 0 || x == nx || y == 0 || y == ny || z == 0 || z == nz)
          out.push_back(x + (nx + 1) * (y + (ny + 1) * z));
  return out;
}

/// A block of springs with rest lengths of all kinds, held at its lowest layer, some axes elsewhere.
inline Organ wobbly_organ(int nx, int ny, int nz) {
  NetworkDescription d = wobbly_block(nx, ny, nz);
  d.fixed.back() = kHeldX | kHeldZ;
  d.fixed[d.fixed.size() / 2] |= kHeldY;
  StiffnessBuilder builder(d.positions, d.fixed);
  builder.add_springs(d.springs);
  return {builder.build(), surface_of_box(nx, ny, nz)};
}

/// Cubes of six tetrahedra each.
inline std::vector<std::array<int, 4>> tets_of(const BoxLattice& box) {
  constexpr int kPaths[6][2] = {{1, 3}, {5, 1}, {3, 2}, {2, 6}, {4, 5}, {6, 4}};
  std::vector<std::array<int, 4>> out;
  for (const auto& c : box.cells)
    for (const auto& p : kPaths) out.push_back({c[0], c[size_t(p[0])], c[size_t(p[1])], c[7]});
  return out;
}

inline std::vector<double> random_numbers(std::size_t n, std::uint64_t seed) {
  core::Random random(seed);
  std::vector<double> out(n);
  for (double& x : out) x = random.uniform(-1, 1);
  return out;
}

/// Largest difference, of the largest number.
inline double relative_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = a.size() == b.size() ? 0 : 1, size = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    most = std::max(most, std::fabs(a[i] - b[i])), size = std::max(size, std::fabs(b[i]));
  return most / size;
}

/// y = C f (n x n)
inline std::vector<double> product(const std::vector<double>& c, const std::vector<double>& f) {
  std::vector<double> y(f.size(), 0.0);
  for (std::size_t j = 0; j < f.size(); ++j)
    for (std::size_t i = 0; i < f.size(); ++i) y[i] += c[j * f.size() + i] * f[j];
  return y;
}

inline std::vector<int> all_nodes(const Stiffness& k) {
  std::vector<int> out;
  for (int i = 0; i < k.nodes(); ++i) out.push_back(i);
  return out;
}

}  // namespace trocar::tissue::test
