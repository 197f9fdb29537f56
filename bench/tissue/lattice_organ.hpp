// A box of springs that lies on its lowest layer: the organ that elastostatic benchmarks are about.
#pragma once

#include <vector>

#include <benchmark/benchmark.h>

#include <trocar/tissue/elastostatic/stiffness.hpp>
#include <trocar/tissue/network/lattice_springs.hpp>

namespace trocar::tissue {

/// A box of nodes on the cubic lattice that lies on its lowest layer, anchored there and at its sides; kept is what can
/// be touched.
struct LatticeOrgan {
  Stiffness k;
  std::vector<int> kept;

  LatticeOrgan(int nx, int ny, int nz) {
    const BoxLattice box = box_lattice(nx - 1, ny - 1, nz - 1, 0.005);
    const NetworkDescription d =
        lattice_network(box.corners, box.cells, {}, {.youngs_modulus = 10e3, .density = 1050}).network;
    StiffnessBuilder builder(d.positions, d.fixed);
    builder.add_springs(d.springs);
    std::vector<Anchor> anchors;
    for (int i = 0; i < int(d.positions.size()); ++i) {
      const int x = i % nx, y = i / nx % ny, z = i / nx / ny;
      const bool side = x == 0 || x == nx - 1 || y == 0 || y == ny - 1;
      if (side || z == nz - 1) kept.push_back(i);
      if (side || z == 0) anchors.push_back({.node = i, .k = 0.5, .x0 = {}});
    }
    builder.add_anchors(anchors);
    k = builder.build();
  }
  void count(benchmark::State& bench) const {
    bench.counters["nodes"] = k.nodes();
    bench.counters["surface"] = double(kept.size());
  }
};

}  // namespace trocar::tissue
