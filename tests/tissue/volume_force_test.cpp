// Nearly incompressible bodies: E and nu are what was asked for, bending does not lock, and what is squeezed bulges.
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/tissue/network/lattice_springs.hpp>
#include <trocar/tissue/tets/cuttable.hpp>

#include "volume_force_reference.hpp"

namespace trocar::tissue {
namespace {

constexpr double kE = 10e3, kCell = 0.005;

/// A bar of nx x ny x nz cubes of six tetrahedra, inner points moved a little.
struct Bar {
  BoxLattice box;
  CuttableDescription d;
  CuttableModel model;
  CuttableState state;
  CuttableWork work;
  std::vector<NodeLoad> loads;

  Bar(int nx, int ny, int nz, double poisson) : box(box_lattice(nx, ny, nz, kCell)) {
    core::Random random(5);
    for (int k = 1; k < nz; ++k)
      for (int j = 1; j < ny; ++j)
        for (int i = 1; i < nx; ++i)
          for (int axis = 0; axis < 3; ++axis)
            box.corners[size_t(box.corner(i, j, k))][axis] += random.uniform(-0.12, 0.12) * kCell;
    d.points = box.corners;
    constexpr int kPaths[6][2] = {{1, 3}, {5, 1}, {3, 2}, {2, 6}, {4, 5}, {6, 4}};
    for (const auto& c : box.cells)
      for (const auto& p : kPaths) d.cells.push_back({c[0], c[size_t(p[0])], c[size_t(p[1])], c[7]});
    d.material = {.youngs_modulus = kE, .poisson = poisson, .density = 1050, .damping_time = 1e-3};
    d.global_damping = 30;
    d.fixed.assign(d.points.size(), kFree);
    d.spare_nodes = 0;
  }
  template <class Where>
  void hold(std::uint8_t axes, Where&& where) {
    for (size_t i = 0; i < d.points.size(); ++i)
      if (where(d.points[i])) d.fixed[i] |= axes;
  }
  void start() {
    model = build(d, 1e-3);
    state = rest_state(model);
    work = make_work(model);
  }
  /// A force spread evenly over the end x = max.
  void load_end(int nx, int ny, int nz, Vec3d force) {
    for (int k = 0; k <= nz; ++k)
      for (int j = 0; j <= ny; ++j) {
        const double share = (j == 0 || j == ny ? 0.5 : 1) * (k == 0 || k == nz ? 0.5 : 1) / (ny * nz);
        NodeLoad load;
        load.node = box.corner(nx, j, k);
        load.f0 = vec_cast<float>(share * force);
        loads.push_back(load);
      }
    std::sort(loads.begin(), loads.end(), [](const NodeLoad& a, const NodeLoad& b) { return a.node < b.node; });
  }
  void ticks(int n) {
    for (int i = 0; i < n; ++i) ASSERT_TRUE(advance(model, loads, {}, state, work).fine()) << i;
  }
  Vec3d moved(int node) const { return position(model, state, node) - d.points[size_t(node)]; }
  double volume() const {
    double v = 0;
    for (const geometry::Tet& c : state.tets.cells) {
      const auto x = [&](int i) { return position(model, state, c[size_t(i)]); };
      v += dot(x(1) - x(0), cross(x(2) - x(0), x(3) - x(0))) / 6;
    }
    return v;
  }
};

TEST(VolumeForce, ModulusAndPoissonsRatioAreWhatWasAskedFor) {
  for (const double nu : {0.25, 0.35, 0.45}) {
    Bar b(8, 4, 4, nu);
    b.hold(kHeldX, [](Vec3d p) { return p.x < 1e-9; });
    b.hold(kHeldY, [](Vec3d p) { return p.y < 1e-9; });
    b.hold(kHeldZ, [](Vec3d p) { return p.z < 1e-9; });
    b.start();
    const double area = 16 * kCell * kCell, strain = 0.02;
    b.load_end(8, 4, 4, {kE * area * strain, 0, 0});
    b.ticks(1500);
    double longer = 0, thinner = 0;
    for (int k = 0; k <= 4; ++k)
      for (int j = 0; j <= 4; ++j) {
        longer += b.moved(b.box.corner(8, j, k)).x / 25 / (8 * kCell);
        thinner -= b.moved(b.box.corner(4, 4, k)).y / 25 / (4 * kCell);
      }
    EXPECT_NEAR(strain / longer, 1, 0.05) << "E, nu = " << nu;
    EXPECT_NEAR(thinner / longer, nu, 0.015);
    std::cout << "nu " << nu << ": E " << strain / longer * kE << " Pa, nu " << thinner / longer << ", "
              << b.model.bulk.impulses << " impulses, " << b.model.substeps << " sub-steps\n";
  }
}

TEST(VolumeForce, BendingDoesNotLock) {
  double tip[2];
  for (int i = 0; i < 2; ++i) {
    Bar b(16, 4, 4, i == 0 ? 0.25 : 0.45);
    b.hold(kHeld, [](Vec3d p) { return p.x < 1e-9; });
    b.start();
    b.load_end(16, 4, 4, {0, 0, -0.002});
    b.ticks(4000);
    tip[i] = -b.moved(b.box.corner(16, 2, 2)).z;
  }
  EXPECT_NEAR(tip[1] / tip[0], 1, 0.1) << "the same E bends about the same, four cells deep and clamped";
}

TEST(VolumeForce, WhatIsSqueezedBulgesInsteadOfShrinking) {
  double lost[2];
  for (int i = 0; i < 2; ++i) {
    Bar b(4, 4, 4, i == 0 ? 0.25 : 0.45);
    b.hold(kHeldX, [](Vec3d p) { return p.x < 1e-9 || p.x > 4 * kCell - 1e-9; });
    b.hold(kHeldY, [](Vec3d p) { return p.y < 1e-9; });
    b.hold(kHeldZ, [](Vec3d p) { return p.z < 1e-9; });
    b.start();
    const double before = b.volume();
    for (int node = 0; node < b.model.own_nodes; ++node) {
      Vec3d p = b.d.points[size_t(node)];
      p.x *= 0.95;
      set_position(b.model, b.state, node, p);
    }
    b.ticks(1500);
    lost[i] = 1 - b.volume() / before;
  }
  EXPECT_NEAR(lost[0], 0.05 * 0.5, 0.004) << "(1 - 2 nu) of the squeeze";
  EXPECT_NEAR(lost[1], 0.05 * 0.1, 0.004);
}

TEST(VolumeForce, ItNeitherPushesNorTurnsTheBodyAsAWhole) {
  Bar b(4, 4, 6, 0.45);
  b.d.global_damping = 0;
  b.d.material.damping_time = 0;
  b.start();
  core::Random random(9);
  for (int i = 0; i < b.model.own_nodes; ++i)
    set_position(b.model, b.state, i,
                 b.d.points[size_t(i)] +
                     0.1 * kCell * Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
  b.ticks(1);
  b.state = rest_state(b.model);
  for (int i = 0; i < b.model.own_nodes; ++i) {
    Vec3d p = b.d.points[size_t(i)];
    p = {p.x * 1.05, p.y * 1.02 + 0.1 * p.x, p.z * 1.04};
    set_position(b.model, b.state, i, p);
  }
  push_volumes(b.work.volume_cells, {}, b.model.bulk, 1e-3, b.model.dt, b.state.nodes, b.work.volume);
  Vec3d push, turn;
  double size = 0;
  for (int i = 0; i < b.model.own_nodes; ++i) {
    const Vec3d p = mass_of(b.model, b.state, i) * velocity(b.model, b.state, i);
    push += p;
    turn += cross(position(b.model, b.state, i), p);
    size += length(p);
  }
  EXPECT_GT(size, 0);
  EXPECT_LT(length(push), 1e-5 * size);
  EXPECT_LT(length(turn), 1e-5 * size * 0.03);
}

/// A bar in disorder: cells pressed flat, turned inside out and blown up among the others, some axes held.
Bar disordered_bar() {
  Bar b(5, 3, 4, 0.45);
  b.hold(kHeldX, [](Vec3d p) { return p.x < 1e-9; });
  b.hold(kHeld, [](Vec3d p) { return p.z < 1e-9 && p.y < 1e-9; });
  b.d.spare_nodes = 40;
  b.start();
  b.ticks(1);
  core::Random random(17);
  for (int i = 0; i < b.model.own_nodes; ++i) {
    const double far = i % 7 ? 0.2 : 1.5;
    const Vec3d off = far * kCell * Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    set_position(b.model, b.state, i, b.d.points[size_t(i)] + off);
  }
  return b;
}

/// Against the plain loop, with every instruction set.
void expect_reference(const Bar& b, std::span<const std::uint8_t> phase) {
  const std::string usual = simd_name();
  const std::span<const RowPack> weight(b.work.row_packs.data(), size_t(b.work.slices));
  std::vector<NodeState> expected = b.state.nodes;
  test::VolumeReference(b.work.guarded, phase, b.model.bulk, weight, b.model.dt).push(5e-4, expected);
  EXPECT_NE(std::memcmp(expected.data(), b.state.nodes.data(), expected.size() * sizeof(NodeState)), 0);
  for (const char* name : {"generic", "sse2", "avx2", "avx512"}) {
    if (!set_simd(name)) continue;
    std::vector<NodeState> nodes = b.state.nodes;
    VolumeWork work = b.work.volume;
    push_volumes(b.work.volume_cells, phase, b.model.bulk, 5e-4, b.model.dt, nodes, work);
    EXPECT_EQ(std::memcmp(expected.data(), nodes.data(), expected.size() * sizeof(NodeState)), 0) << name;
  }
  set_simd(usual);
}

TEST(VolumeForce, EveryInstructionSetGivesTheBitsOfThePlainLoop) {
  const Bar b = disordered_bar();
  expect_reference(b, {});
  std::vector<std::uint8_t> phase(b.work.guarded.size(), 0);
  for (size_t t = 0; t < phase.size(); t += 3) phase[t] = t % 2 ? kGone : 5;
  expect_reference(b, phase);
}

TEST(VolumeForce, ACutBodyGetsTheBitsOfThePlainLoop) {
  Bar b = disordered_bar();
  for (int i = 0; i < b.model.own_nodes; ++i) set_position(b.model, b.state, i, b.d.points[size_t(i)]);
  geometry::Blade blade;
  blade.corners = 4;
  const double x = 2.4 * kCell;
  blade.corner = {Vec3d{x, -1, -1}, Vec3d{x, 1, -1}, Vec3d{x, 1, 2.5 * kCell}, Vec3d{x, -1, 2.5 * kCell}};
  ASSERT_GT(cut(b.model, blade, b.state, b.work).parted, 0);
  b.ticks(20);
  ASSERT_GT(b.state.tets.nodes, b.model.own_nodes);
  expect_reference(b, {});
}

TEST(VolumeForce, AnUndampedBodysMotionStaysBounded) {
  Bar b(6, 4, 4, 0.45);
  b.d.global_damping = 0;
  b.d.material.damping_time = 0;
  b.start();
  for (int i = 0; i < b.model.own_nodes; ++i) {
    const Vec3d p = b.d.points[size_t(i)];
    set_velocity(b.model, b.state, i, {3 * (p.x - 0.015), -1 * (p.y - 0.01), 0.5 * p.x});
  }
  const auto kinetic = [&] {
    double e = 0;
    for (int i = 0; i < b.model.own_nodes; ++i)
      e += 0.5 * mass_of(b.model, b.state, i) * dot(velocity(b.model, b.state, i), velocity(b.model, b.state, i));
    return e;
  };
  const double at_start = kinetic();
  double most = 0;
  for (int i = 0; i < 3000; ++i) {
    b.ticks(1);
    if (i % 20 == 0) most = std::max(most, kinetic());
  }
  EXPECT_LT(most, 1.1 * at_start) << "three seconds";
}

TEST(VolumeForce, ALatticeHasThePoissonsRatioThatWasAskedFor) {
  constexpr double kNu = 0.4;
  const BoxLattice box = box_lattice(8, 4, 4, kCell);
  const BulkShare share = bulk_share(kE, kNu);
  NetworkDescription d =
      lattice_network(box.corners, box.cells, {},
                      {.youngs_modulus = share.spring_modulus, .density = 1050, .damping_time = 1e-3})
          .network;
  d.kappa = share.kappa;
  d.global_damping = 30;
  d.fixed.assign(d.positions.size(), kFree);
  for (size_t i = 0; i < d.positions.size(); ++i) {
    const Vec3d p = d.positions[i];
    if (p.x < 1e-9 || p.x > 8 * kCell - 1e-9) d.fixed[i] |= kHeldX;
    if (p.y < 1e-9) d.fixed[i] |= kHeldY;
    if (p.z < 1e-9) d.fixed[i] |= kHeldZ;
  }
  const NetworkModel model = build(d, 1e-3);
  NetworkState state = rest_state(model);
  NetworkWork work = make_work(model);
  for (int i = 0; i < model.nodes; ++i) {
    Vec3d p = d.positions[size_t(i)];
    p.x *= 1.02;
    set_position(model, state, i, p);
  }
  for (int tick = 0; tick < 1500; ++tick) ASSERT_TRUE(advance(model, {}, {}, state, work).fine());
  const int side = box.corner(4, 4, 2);
  const double thinner = (d.positions[size_t(side)].y - position(model, state, side).y) / (4 * kCell);
  EXPECT_NEAR(thinner / 0.02, kNu, 0.02);
}

TEST(VolumeForce, RefusesWhatImpulsesCannotHold) {
  Bar b(2, 2, 2, 0.49);
  EXPECT_THROW(build(b.d, 1e-3), std::invalid_argument);
}

}  // namespace
}  // namespace trocar::tissue
