#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/tissue/network/lattice_springs.hpp>
#include <trocar/tissue/tets/tet_springs.hpp>

#include "linear_solve.hpp"

namespace trocar::tissue {
namespace {

constexpr double kE = 10e3, kRho = 1060;

/// A cube of n^3 cells of six tetrahedra each; inner points moved by up to `jitter` of a cell.
struct Block {
  BoxLattice box;
  std::vector<std::array<int, 4>> cells;
  int n;
  double h;

  explicit Block(int count, double spacing = 0.005, double jitter = 0)
      : box(box_lattice(count, count, count, spacing)), n(count), h(spacing) {
    constexpr int kPaths[6][2] = {{1, 3}, {1, 5}, {2, 3}, {2, 6}, {4, 5}, {4, 6}};
    for (const auto& c : box.cells)
      for (const auto& p : kPaths) {
        std::array<int, 4> tet{c[0], c[p[0]], c[p[1]], c[7]};
        if (volume6(tet) < 0) std::swap(tet[1], tet[2]);
        cells.push_back(tet);
      }
    core::Random random(3);
    for (int k = 1; k < n; ++k)
      for (int j = 1; j < n; ++j)
        for (int i = 1; i < n; ++i)
          for (int axis = 0; axis < 3; ++axis)
            box.corners[size_t(box.corner(i, j, k))][axis] += random.uniform(-jitter, jitter) * h;
  }
  double volume6(const std::array<int, 4>& t) const {
    const auto x = [&](int i) { return box.corners[size_t(t[size_t(i)])]; };
    return dot(x(1) - x(0), cross(x(2) - x(0), x(3) - x(0)));
  }
  TetNetwork network(const TetMaterial& m) const { return tet_network(box.corners, cells, m); }

  /// Young's modulus and Poisson's ratio when the two faces across `axis` are pulled apart by their shares.
  std::array<double, 2> pulled(const NetworkDescription& d, int axis) const {
    const double strain = 1e-3;
    std::vector<Vec3d> load(d.positions.size());
    std::vector<bool> held(d.positions.size(), false);
    const auto corner = [&](int u, int v, int w) {
      int at[3];
      at[axis] = w, at[(axis + 1) % 3] = u, at[(axis + 2) % 3] = v;
      return size_t(box.corner(at[0], at[1], at[2]));
    };
    for (const auto& t : cells) {  // each face triangle brings a third of its area to its corners
      for (int out = 0; out < 4; ++out) {
        std::array<int, 3> face;
        for (int i = 0, k = 0; i < 4; ++i)
          if (i != out) face[size_t(k++)] = t[size_t(i)];
        for (const double end : {0.0, n * h}) {
          if (!std::all_of(face.begin(), face.end(), [&](int i) { return box.corners[size_t(i)][axis] == end; }))
            continue;
          const auto x = [&](int i) { return box.corners[size_t(face[size_t(i)])]; };
          const double area = 0.5 * length(cross(x(1) - x(0), x(2) - x(0)));
          for (const int i : face) load[size_t(i)][axis] += (end > 0 ? 1 : -1) * kE * strain * area / 3;
        }
      }
    }
    held[corner(n / 2, n / 2, 0)] = held[corner(n / 2 + 1, n / 2, 0)] = held[corner(n / 2, n / 2 + 1, 0)] = true;
    const auto u = solve(d, load, held);
    const int b = (axis + 1) % 3;
    double along = 0, aside = 0;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j) {
        along += u[corner(i, j, n)][axis] - u[corner(i, j, 0)][axis];
        aside += u[corner(n, i, j)][b] - u[corner(0, i, j)][b];
      }
    const double area = (n + 1.0) * (n + 1.0) * n * h;
    return {kE * strain / (along / area), -aside / along};
  }
};

TEST(TetSprings, ABlockHasItsModulusAndPoissonsRatioOneQuarterInEveryDirection) {
  // Six tetrahedra to a cube, then the same with inner points moved by a tenth and a fifth of a cell.
  const struct {
    double jitter, modulus_within, poisson_within;
  } cases[] = {{0, 0.015, 0.005}, {0.1, 0.03, 0.01}, {0.2, 0.06, 0.01}};
  for (const auto& c : cases) {
    const Block block(6, 0.005, c.jitter);
    const TetNetwork t = block.network({.youngs_modulus = kE, .density = kRho});
    EXPECT_LT(t.misfit, 0.4 * t.misfit_start);
    for (int axis = 0; axis < 3; ++axis) {
      const auto [e, nu] = block.pulled(t.network, axis);
      EXPECT_NEAR(e, kE, c.modulus_within * kE) << "jitter " << c.jitter << ", axis " << axis;
      EXPECT_NEAR(nu, 0.25, c.poisson_within) << "jitter " << c.jitter << ", axis " << axis;
    }
  }
}

TEST(TetSprings, WithoutSpringsAcrossFacesPoissonsRatioIsLost) {
  // Why they are there: edges alone leave out whole directions.
  const Block block(6);
  const TetNetwork t = block.network({.youngs_modulus = kE, .density = kRho, .across_faces = false, .sweeps = 0});
  EXPECT_TRUE(t.cells_of_cross_spring.empty());
  EXPECT_LT(block.pulled(t.network, 0)[1], 0.1);
}

TEST(TetSprings, FibresMakeABlockStifferAlongThem) {
  const Block block(6, 0.005, 0.1);
  for (const double ratio : {1.5, 2.0}) {
    const TetNetwork t =
        block.network({.youngs_modulus = kE, .density = kRho, .fibre_ratio = ratio, .fibre = {0, 0, 1}});
    EXPECT_NEAR(block.pulled(t.network, 2)[0], ratio * kE, 0.06 * ratio * kE) << ratio;
    for (const int axis : {0, 1}) EXPECT_NEAR(block.pulled(t.network, axis)[0], kE, 0.06 * kE) << ratio;
  }
}

TEST(TetSprings, EveryCellMayHaveItsOwnFibres) {
  const Block block(4, 0.005, 0.1);
  const TetMaterial m{.youngs_modulus = kE, .density = kRho, .fibre_ratio = 2, .fibre = {0, 0, 3}};
  const std::vector<Vec3d> same(block.cells.size(), Vec3d{0, 0, 1});
  const TetNetwork one = block.network(m), each = tet_network(block.box.corners, block.cells, m, same);
  ASSERT_EQ(one.network.springs.size(), each.network.springs.size());
  for (std::size_t i = 0; i < one.network.springs.size(); ++i)
    EXPECT_DOUBLE_EQ(one.network.springs[i].k, each.network.springs[i].k);
}

TEST(TetSprings, MassIsDensityTimesVolume) {
  const Block block(5, 0.004, 0.2);
  double mass = 0;
  for (const double m : block.network({.youngs_modulus = kE, .density = kRho}).network.mass) mass += m;
  EXPECT_NEAR(mass, kRho * 0.02 * 0.02 * 0.02, 1e-12 * mass);
}

TEST(TetSprings, RunsInTheKernelAndHangsAsStillAsItShould) {
  // The network is one that the kernel can build: hung from its top face it sags by rho g L^2 / 2 E.
  const Block block(6, 0.005, 0.1);
  TetNetwork t = block.network({.youngs_modulus = kE, .density = kRho, .damping_time = 2e-3});
  NetworkDescription& d = t.network;
  const int n = block.n;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) d.fixed[size_t(block.box.corner(i, j, n))] = kHeldZ;
  d.fixed[size_t(block.box.corner(n / 2, n / 2, n))] = kHeld;
  d.fixed[size_t(block.box.corner(0, n / 2, n))] = kHeldZ | kHeldY;
  d.gravity = {0, 0, -9.81};
  d.global_damping = 1;
  const NetworkModel model = build(d, 1e-3);
  NetworkState s = rest_state(model);
  NetworkWork w = make_work(model);
  for (int tick = 0; tick < 4000; ++tick) ASSERT_TRUE(advance(model, {}, {}, s, w).fine());
  double sag = 0;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) sag -= position(model, s, block.box.corner(i, j, 0)).z / ((n + 1) * (n + 1));
  const double side = n * block.h;
  EXPECT_NEAR(sag, kRho * 9.81 * side * side / (2 * kE), 0.06 * sag);
}

TEST(TetSprings, RefusesWhatIsUnsound) {
  const std::vector<Vec3d> x{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  const TetMaterial m{.youngs_modulus = kE, .density = kRho};
  const auto refuses = [&](std::vector<std::array<int, 4>> cells) {
    EXPECT_THROW(tet_network(x, cells, m), std::invalid_argument);
  };
  refuses({});
  refuses({{0, 1, 2, 3}});                // point 4 is not used
  refuses({{0, 2, 1, 3}, {1, 2, 3, 4}});  // turned inside out
  refuses({{0, 1, 2, 5}});
  EXPECT_NO_THROW(tet_network(x, std::vector<std::array<int, 4>>{{0, 1, 2, 3}, {1, 2, 3, 4}}, m));
}

}  // namespace
}  // namespace trocar::tissue
