#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/tissue/network/lattice_springs.hpp>

#include "linear_solve.hpp"

namespace trocar::tissue {
namespace {

constexpr double kE = 30e3, kRho = 1050;

TEST(LatticeSprings, ARegularBlockHasItsModulusAndPoissonsRatioOneQuarter) {
  // The field of uniaxial tension must leave every node in balance but those of the two end faces, and these must carry
  // E times strain times their share of the face: inner nodes, faces, edges and corners each test their weights.
  const int n = 4;
  const double h = 0.005, strain = 1e-3, nu = 0.25;
  const BoxLattice box = box_lattice(n, n, n, h);
  const NetworkDescription d =
      lattice_network(box.corners, box.cells, {}, {.youngs_modulus = kE, .density = kRho}).network;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Vec3d> u;
    for (const Vec3d& x : d.positions) {
      Vec3d v = -nu * strain * x;
      v[axis] = strain * x[axis];
      u.push_back(v);
    }
    const auto f = forces(d, u);
    const double unit = kE * strain * h * h;  // force on one cell's face
    for (int k = 0; k <= n; ++k) {
      for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
          const int at[3] = {i, j, k};
          double share = at[axis] == 0 ? -1 : (at[axis] == n ? 1 : 0);
          for (int other = 0; other < 3; ++other)
            if (other != axis && (at[other] == 0 || at[other] == n)) share *= 0.5;
          Vec3d expected{};
          expected[axis] = share * unit;
          EXPECT_LT(length(f[box.corner(i, j, k)] - expected), 1e-9 * unit);
        }
      }
    }
  }
}

TEST(LatticeSprings, ShearModulusIsTwoFifthsOfE) {
  const int n = 4;
  const double h = 0.005, angle = 1e-3;
  const BoxLattice box = box_lattice(n, n, n, h);
  const NetworkDescription d =
      lattice_network(box.corners, box.cells, {}, {.youngs_modulus = kE, .density = kRho}).network;
  std::vector<Vec3d> u;
  for (const Vec3d& x : d.positions) u.push_back({angle * x.z, 0, 0});
  const auto f = forces(d, u);
  double top = 0;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) top += f[box.corner(i, j, n)].x;
  EXPECT_NEAR(top, 0.4 * kE * angle * n * n * h * h, 1e-9 * top);
}

TEST(LatticeSprings, AnIrregularBlockKeepsItsModulusWithinTenPercent) {
  const int n = 6;
  const double h = 0.005, strain = 1e-3;
  BoxLattice box = box_lattice(n, n, n, h);
  core::Random random(3);
  for (int k = 1; k < n; ++k)
    for (int j = 1; j < n; ++j)
      for (int i = 1; i < n; ++i)
        for (int axis = 0; axis < 3; ++axis) box.corners[box.corner(i, j, k)][axis] += random.uniform(-0.15, 0.15) * h;
  const NetworkDescription d =
      lattice_network(box.corners, box.cells, {}, {.youngs_modulus = kE, .density = kRho}).network;
  // End faces pulled by their shares; the middle of each face tells the elongation.
  std::vector<Vec3d> load(d.positions.size());
  std::vector<bool> held(d.positions.size(), false);
  const double unit = kE * strain * h * h;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double share = (i == 0 || i == n ? 0.5 : 1) * (j == 0 || j == n ? 0.5 : 1);
      load[box.corner(i, j, 0)].z -= share * unit;
      load[box.corner(i, j, n)].z += share * unit;
    }
  held[box.corner(n / 2, n / 2, 0)] = held[box.corner(n / 2 + 1, n / 2, 0)] = held[box.corner(n / 2, n / 2 + 1, 0)] =
      true;
  const auto u = solve(d, load, held);
  double top = 0, bottom = 0;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) top += u[box.corner(i, j, n)].z, bottom += u[box.corner(i, j, 0)].z;
  const double measured = (top - bottom) / ((n + 1) * (n + 1)) / (n * h);
  EXPECT_NEAR(measured, strain, 0.1 * strain);
}

TEST(LatticeSprings, FillScalesMassAndStiffness) {
  const BoxLattice box = box_lattice(3, 3, 3, 0.004);
  const std::vector<double> half(box.cells.size(), 0.5);
  const LatticeMaterial material{.youngs_modulus = kE, .density = kRho};
  const NetworkDescription full = lattice_network(box.corners, box.cells, {}, material).network;
  const NetworkDescription thin = lattice_network(box.corners, box.cells, half, material).network;
  double mass = 0;
  for (double m : full.mass) mass += m;
  EXPECT_NEAR(mass, kRho * std::pow(0.012, 3), 1e-12);
  ASSERT_EQ(full.springs.size(), thin.springs.size());
  for (std::size_t s = 0; s < full.springs.size(); ++s)
    EXPECT_NEAR(thin.springs[s].k, 0.5 * full.springs[s].k, 1e-12 * full.springs[s].k);
  for (std::size_t i = 0; i < full.mass.size(); ++i) EXPECT_NEAR(thin.mass[i], 0.5 * full.mass[i], 1e-15);
}

TEST(LatticeSprings, AKernelRunReadsTheModulusOffAPulledBlock) {
  // End to end in float: eq. 3 with axis-wise held nodes and constant loads, settled.
  const int n = 5;
  const double h = 0.01, strain = 0.01;
  const BoxLattice box = box_lattice(n, n, n, h, {0.1, 0.2, -0.1});
  NetworkDescription d =
      lattice_network(box.corners, box.cells, {}, {.youngs_modulus = kE, .density = kRho, .damping_time = 1e-4})
          .network;
  d.global_damping = 30;
  std::vector<NodeLoad> loads;
  const double unit = kE * strain * h * h;
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        auto& held = d.fixed[box.corner(i, j, k)];
        if (i == 0) held |= kHeldX;
        if (j == 0) held |= kHeldY;
        if (k == 0) held |= kHeldZ;
        const double share = (k == 0 || k == n ? 0.5 : 1) * (j == 0 || j == n ? 0.5 : 1);
        if (i == n) loads.push_back({.node = box.corner(i, j, k), .f0 = {float(share * unit), 0, 0}});
      }
  std::sort(loads.begin(), loads.end(), [](const NodeLoad& a, const NodeLoad& b) { return a.node < b.node; });
  const NetworkModel m = build(d, 1e-3);
  NetworkState s = rest_state(m);
  NetworkWork w = make_work(m);
  for (int t = 0; t < 3000; ++t) ASSERT_TRUE(advance(m, loads, {}, s, w).fine());
  const Vec3d corner = position(m, s, box.corner(n, n, n)) - m.rest[box.corner(n, n, n)];
  EXPECT_NEAR(corner.x / (n * h), strain, 0.01 * strain);  // 1 %: finite strain
  EXPECT_NEAR(-corner.y / corner.x, 0.25, 0.01);
}

}  // namespace
}  // namespace trocar::tissue
