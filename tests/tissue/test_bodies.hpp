// Bodies that several tests of the tissue use.
#pragma once

#include <trocar/core/random.hpp>
#include <trocar/tissue/network/lattice_springs.hpp>
#include <trocar/tissue/network/network.hpp>

namespace trocar::tissue::test {

/// A liver-like block, positions jittered so that no two springs are alike, its lowest layer held.
inline NetworkDescription wobbly_block(int nx, int ny, int nz, std::uint64_t seed = 1) {
  const double h = 0.01;
  const BoxLattice box = box_lattice(nx, ny, nz, h, {0.02, -0.03, 0.1});
  LatticeNetwork lattice = lattice_network(
      box.corners, box.cells, {},
      {.youngs_modulus = 5.4e3, .density = 1060, .p1 = 2, .p2 = 100, .cap = 0.35, .damping_time = 4e-4});
  NetworkDescription d = lattice.network;
  core::Random random(seed);
  for (auto& e : d.springs) e.rest_length *= random.uniform(0.97, 1.03);
  for (int i = 0; i < int(d.positions.size()); ++i)
    if (i < (nx + 1) * (ny + 1)) d.fixed[i] = kHeld;
  d.gravity = {0, 0, -9.81};
  d.global_damping = 0.5;
  return d;
}

/// Two nodes along x, the first held, one spring.
inline NetworkDescription oscillator(double mass, double k, double damping, double rest = 0.1) {
  NetworkDescription d;
  d.positions = {{0, 0, 0}, {rest, 0, 0}};
  d.mass = {mass, mass};
  d.fixed = {kHeld, kFree};
  d.springs = {{.a = 0, .b = 1, .rest_length = rest, .k = k, .damping = damping}};
  return d;
}

}  // namespace trocar::tissue::test
