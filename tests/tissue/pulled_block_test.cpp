// A block pulled and pushed along x by its end faces, run with the integrator until it rests, in double and in float:
// Young's modulus from the force on the ends, Poisson's ratio from its width.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/tissue/network/lattice_springs.hpp>
#include <trocar/tissue/network/network_reference.hpp>
#include <trocar/tissue/tets/tet_springs.hpp>

#include "validation.hpp"

namespace trocar::tissue {
namespace {

using test::expect_order;
using test::expect_within;
using test::precision;

constexpr double kE = 30e3, kRho = 1050, kSide = 0.04;  // [Pa] [kg/m^3] [m]

struct Block {
  int n;
  BoxLattice box;
  NetworkDescription d;

  /// @param jitter  how far inner corners are moved, in cells
  explicit Block(int cells, double jitter = 0) : n(cells), box(box_lattice(cells, cells, cells, kSide / cells)) {
    core::Random random(3);
    for (int k = 1; k < n; ++k)
      for (int j = 1; j < n; ++j)
        for (int i = 1; i < n; ++i)
          for (int axis = 0; axis < 3; ++axis)
            box.corners[size_t(box.corner(i, j, k))][axis] += random.uniform(-jitter, jitter) * kSide / n;
  }
  void fill_with_lattice() {
    finish(lattice_network(box.corners, box.cells, {}, {.youngs_modulus = kE, .density = kRho, .damping_time = 1e-4})
               .network);
  }
  /// Six tetrahedra to a cell.
  void fill_with_tetrahedra() {
    constexpr int kPaths[6][2] = {{1, 3}, {5, 1}, {3, 2}, {2, 6}, {4, 5}, {6, 4}};
    std::vector<std::array<int, 4>> tets;
    for (const auto& c : box.cells)
      for (const auto& p : kPaths) tets.push_back({c[0], c[size_t(p[0])], c[size_t(p[1])], c[7]});
    finish(tet_network(box.corners, tets, {.youngs_modulus = kE, .density = kRho, .damping_time = 1e-4}).network);
  }
  /// Both ends are held along x; the planes y = 0 and z = 0 are planes of symmetry.
  void finish(NetworkDescription network) {
    d = std::move(network);
    d.global_damping = 400;  // about critical for the slowest breathing
    d.fixed.assign(d.positions.size(), kFree);
    for (int k = 0; k <= n; ++k)
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
          std::uint8_t& held = d.fixed[size_t(box.corner(i, j, k))];
          if (i == 0 || i == n) held |= kHeldX;
          if (j == 0) held |= kHeldY;
          if (k == 0) held |= kHeldZ;
        }
  }
};

struct Pulled {
  double force, narrowing;  ///< on the far end [N]; share by which its width shrinks
};
template <class Real>
Pulled pull(const Block& b, double strain) {
  const NetworkModel m = build(b.d, 1e-3);
  ReferenceNetwork<Real> network(b.d, m);
  for (int i = 0; i < m.nodes; ++i) network.node(i).x.x += Real(strain * b.d.positions[size_t(i)].x);
  for (int step = 0; step < 1000; ++step) network.step(m.dt);
  Pulled out{0, 0};
  for (int k = 0; k <= b.n; ++k)
    for (int j = 0; j <= b.n; ++j) {
      out.force -= double(network.force(network.row_of(b.box.corner(b.n, j, k))).x);
      const double now = double(network.node(b.box.corner(j, b.n, k)).x.y) + m.origin.y;
      out.narrowing += (1 - now / kSide) / ((b.n + 1) * (b.n + 1));
    }
  return out;
}

struct Elastic {
  double modulus, poisson;  ///< relative error of E; error of nu beside 1/4
};
/// From a pull and a push of the same strain.
template <class Real>
Elastic measured(const Block& b, double strain) {
  const Pulled longer = pull<Real>(b, strain), shorter = pull<Real>(b, -strain);
  return {(longer.force - shorter.force) / (2 * strain * kSide * kSide) / kE - 1,
          (longer.narrowing - shorter.narrowing) / (2 * strain) - 0.25};
}

template <class Real>
void expect_block(const std::string& what, const Block& b, double modulus_within, double poisson_within) {
  const Elastic e = measured<Real>(b, 1e-3);
  expect_within("row 5, E of " + what, precision<Real>(), e.modulus, modulus_within);
  expect_within("row 5, nu of " + what, precision<Real>(), e.poisson, poisson_within);
}

TEST(PulledBlock, ARegularLatticeHasItsModulusAndPoissonsRatioOneQuarter) {
  Block b(4);
  b.fill_with_lattice();
  expect_block<double>("a regular lattice", b, 1e-3, 1e-3);
  expect_block<float>("a regular lattice", b, 1e-3, 1e-3);
}

TEST(PulledBlock, WhatIsLeftIsFiniteStrain) {
  // The mapping itself is exact (LatticeSprings.ARegularBlockHasItsModulusAndPoissonsRatioOneQuarter); springs turn as
  // the block stretches, which is a share of order strain in a pull alone, and of its square in pull and push together.
  Block b(4);
  b.fill_with_lattice();
  std::vector<double> alone, both;
  for (const double strain : {0.04, 0.02, 0.01}) {
    alone.push_back(pull<double>(b, strain).force / (kE * strain * kSide * kSide) - 1);
    both.push_back(measured<double>(b, strain).modulus);
  }
  expect_order("row 5, E of a pull by 0.04, 0.02, 0.01", "f64", alone, 1, 0.1);
  expect_order("row 5, E of pull and push by 0.04, 0.02, 0.01", "f64", both, 2, 0.1);
}

TEST(PulledBlock, ARegularLatticeIsExactAtAnyFineness) {
  // No order of convergence in the cells: two of them are as good as six.
  for (const int cells : {2, 3, 6}) {
    Block b(cells);
    b.fill_with_lattice();
    expect_within("row 5, E of a regular lattice, cells along a side: " + std::to_string(cells), "f64",
                  measured<double>(b, 1e-3).modulus, 1e-5);
  }
}

TEST(PulledBlock, AnIrregularLatticeKeepsItsModulusWithinTenPercent) {
  std::vector<double> errors;
  for (const double jitter : {0.15, 0.1, 0.05}) {
    Block b(6, jitter);
    b.fill_with_lattice();
    const std::string what = "a lattice moved by " + std::to_string(jitter).substr(0, 4) + " cells";
    expect_block<double>(what, b, 0.1, 0.1);
    expect_block<float>(what, b, 0.1, 0.1);
    errors.push_back(measured<double>(b, 1e-3).modulus);
  }
  expect_order("row 5, E of a lattice moved by 0.15, 0.10, 0.05 cells", "f64", errors, 2, 0.1);
}

TEST(PulledBlock, TetrahedraKeepModulusAndPoissonsRatio) {
  const struct { double jitter, modulus_within, poisson_within; } cases[] = {{0, 0.015, 0.005}, {0.2, 0.06, 0.01}};
  for (const auto& c : cases) {
    Block b(6, c.jitter);
    b.fill_with_tetrahedra();
    const std::string what = "tetrahedra moved by " + std::to_string(c.jitter).substr(0, 3) + " cells";
    expect_block<double>(what, b, c.modulus_within, c.poisson_within);
    expect_block<float>(what, b, c.modulus_within, c.poisson_within);
  }
}

TEST(PulledBlock, TetrahedraAreAFewPercentTooStiffHoweverFine) {
  // No convergence: deep inside a regular mesh forces balance at every node whatever the stiffnesses are, so the fit of
  // tet_springs.hpp knows the modulus from the surface alone, and the deeper a spring the less.
  for (const int cells : {4, 8, 12}) {
    Block b(cells);
    b.fill_with_tetrahedra();
    expect_within("row 5, E of tetrahedra, cells along a side: " + std::to_string(cells), "f64",
                  measured<double>(b, 1e-3).modulus, 0.03);
  }
}

}  // namespace
}  // namespace trocar::tissue
