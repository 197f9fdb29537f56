#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/tissue/network/lattice_springs.hpp>
#include <trocar/tissue/tets/cuttable.hpp>

namespace trocar::tissue {
namespace {

using geometry::Blade;
using geometry::CutResult;

/// A bar of nx x ny x nz cubes of six tetrahedra each, inner points moved a little.
CuttableDescription bar(int nx, int ny, int nz, double h = 0.005) {
  CuttableDescription d;
  BoxLattice box = box_lattice(nx, ny, nz, h);
  core::Random random(3);
  for (int k = 1; k < nz; ++k)
    for (int j = 1; j < ny; ++j)
      for (int i = 1; i < nx; ++i)
        for (int axis = 0; axis < 3; ++axis)
          box.corners[size_t(box.corner(i, j, k))][axis] += random.uniform(-0.15, 0.15) * h;
  d.points = box.corners;
  constexpr int kPaths[6][2] = {{1, 3}, {5, 1}, {3, 2}, {2, 6}, {4, 5}, {6, 4}};
  for (const auto& c : box.cells)
    for (const auto& p : kPaths) d.cells.push_back({c[0], c[size_t(p[0])], c[size_t(p[1])], c[7]});
  d.material = {.youngs_modulus = 5.4e3, .density = 1060, .p1 = 2, .p2 = 100, .cap = 0.2, .damping_time = 1e-3};
  d.global_damping = 0.5;
  return d;
}

CuttableDescription hung(int nx, int ny, int nz, double h = 0.005) {
  CuttableDescription d = bar(nx, ny, nz, h);
  d.gravity = {0, 0, -9.81};
  d.fixed.assign(d.points.size(), kFree);
  for (size_t i = 0; i < d.points.size(); ++i)
    if (d.points[i].z > nz * h - 1e-9) d.fixed[i] = kHeld;
  return d;
}

Blade rectangle(Vec3d middle, Vec3d u, Vec3d v) {
  Blade b;
  b.corners = 4;
  b.corner = {middle - u - v, middle + u - v, middle + u + v, middle - u + v};
  return b;
}

struct Body {
  CuttableModel model;
  CuttableState state;
  CuttableWork work;
  explicit Body(const CuttableDescription& d, double tick = 1e-3)
      : model(build(d, tick)), state(rest_state(model)), work(make_work(model)) {}
  void ticks(int n) {
    for (int i = 0; i < n; ++i) ASSERT_TRUE(advance(model, {}, {}, state, work).fine()) << i;
  }
  CutResult cut(const Blade& b) { return tissue::cut(model, b, state, work); }
  double mass() const {
    double sum = 0;
    for (int i = 0; i < state.tets.nodes; ++i) sum += mass_of(model, state, i);
    return sum;
  }
  Vec3d momentum() const {
    Vec3d p;
    for (int i = 0; i < state.tets.nodes; ++i) p += mass_of(model, state, i) * velocity(model, state, i);
    return p;
  }
  double fastest() const {
    double most = 0;
    for (int i = 0; i < state.tets.nodes; ++i) most = std::max(most, length(velocity(model, state, i)));
    return most;
  }
  double lowest() const {
    double z = 1e9;
    for (int i = 0; i < state.tets.nodes; ++i) z = std::min(z, position(model, state, i).z);
    return z;
  }
};

TEST(Cuttable, UncutItIsTheNetworkOfItsTetrahedra) {
  CuttableDescription d = hung(4, 4, 8);
  Body b(d);
  TetNetwork t = tet_network(d.points, d.cells, d.material);
  t.network.fixed = d.fixed;
  t.network.gravity = d.gravity;
  t.network.global_damping = d.global_damping;
  prestress(t.network);
  const NetworkModel n = build(t.network, 1e-3);
  NetworkState s = rest_state(n);
  NetworkWork w = make_work(n);
  for (size_t i = 0; i < d.points.size(); ++i) {
    const Vec3d v{0, 0.3 * d.points[i].z, 0};
    if (d.fixed[i]) continue;
    set_velocity(b.model, b.state, int(i), v);
    set_velocity(n, s, int(i), v);
  }
  for (int tick = 0; tick < 100; ++tick) {
    ASSERT_TRUE(advance(n, {}, {}, s, w).fine());
    b.ticks(1);
  }
  for (int i = 0; i < n.nodes; ++i) EXPECT_LT(length(position(n, s, i) - position(b.model, b.state, i)), 2e-6) << i;
}

TEST(Cuttable, TheDrawnShapeHangsStill) {
  Body b(hung(4, 4, 8));
  const double low = b.lowest();
  b.ticks(1000);
  EXPECT_NEAR(b.lowest(), low, 2e-5);
  EXPECT_LT(b.fastest(), 1e-3);
}

TEST(Cuttable, WhatIsCutOffFallsFreelyAndTheRestStaysUp) {
  Body b(hung(4, 4, 12));
  const double mass = b.mass();
  b.ticks(50);
  const CutResult book = b.cut(rectangle({0.01, 0.01, 0.0222}, {0.05, 0.002, 0.002}, {0, 0.05, 0.001}));
  ASSERT_GT(book.parted, 0);
  EXPECT_NEAR(b.mass(), mass + b.model.density * book.volume, 1e-9 * mass) << "to the last microgram";
  const double low = b.lowest();
  b.ticks(200);
  const double fallen = low - b.lowest();
  EXPECT_NEAR(fallen, 0.5 * 9.81 * 0.2 * 0.2, 0.06 * fallen) << "half g t^2, less a little drag";
  int up = 0;
  for (int i = 0; i < b.state.tets.nodes; ++i) up += position(b.model, b.state, i).z > 0.0;
  EXPECT_GT(up, b.state.tets.nodes / 2);
}

TEST(Cuttable, ACutGivesNoPush) {
  // Momentum in free flight is what it was, and at rest it stays at rest.
  CuttableDescription d = bar(6, 4, 4);
  d.global_damping = 0;
  Body b(d);
  for (int i = 0; i < b.state.tets.nodes; ++i) set_velocity(b.model, b.state, i, {0.1, 0.2, -0.1});
  const Vec3d before = b.momentum();
  b.cut(rectangle({0.0141, 0.01, 0.01}, {0.001, 0.05, 0.002}, {0.002, 0, 0.05}));
  EXPECT_LT(length(b.momentum() - before), 1e-6 * length(before));
  b.ticks(500);
  EXPECT_LT(length(b.momentum() - before), 2e-4 * length(before));
  Body still(d);
  still.cut(rectangle({0.0141, 0.01, 0.01}, {0.001, 0.05, 0.002}, {0.002, 0, 0.05}));
  still.ticks(100);
  EXPECT_LT(still.fastest(), 1e-3) << "a snap moves nodes in the drawn shape and now alike";
}

TEST(Cuttable, AStretchedBarGapesWhereItIsCutHalfThrough) {
  CuttableDescription d = bar(12, 4, 4);
  d.fixed.assign(d.points.size(), kFree);
  for (size_t i = 0; i < d.points.size(); ++i)
    if (d.points[i].x < 1e-9 || d.points[i].x > 0.06 - 1e-9) d.fixed[i] = kHeld;
  Body b(d);
  for (int i = 0; i < b.state.tets.nodes; ++i) {  // pulled by a tenth
    NodeState& n = b.state.nodes[size_t(b.model.row_of_node[size_t(i)])];
    n.x *= 1.1f;
  }
  b.ticks(300);
  const CutResult book = b.cut(rectangle({0.0302, 0.01, 0.02}, {0, 0.05, 0}, {0, 0, 0.0095}));
  ASSERT_GT(book.doubled, 0);
  b.ticks(500);
  double gap = 0;
  for (int i = book.first_new; i < b.state.tets.nodes; ++i)
    gap = std::max(gap,
                   length(position(b.model, b.state, i) - position(b.model, b.state, b.state.tets.source[size_t(i)])));
  EXPECT_GT(gap, 0.001);
  EXPECT_LT(gap, 0.02);
}

TEST(Cuttable, ManyRandomCutsInALivingBodyStayFiniteAndBounded) {
  CuttableDescription d = hung(8, 6, 10);
  d.spare_nodes = 6000;
  Body b(d);
  core::Random random(17);
  const double mass = b.mass();
  for (int i = 0; i < 100; ++i) {
    const auto any = [&] { return random.uniform(-0.012, 0.012); };
    const Vec3d middle{random.uniform(0, 0.04), random.uniform(0, 0.03), random.uniform(0, 0.05)};
    const Vec3d u{any(), any(), any()}, v{any(), any(), any()};
    const CutResult book = b.cut(rectangle(middle, u, v - (dot(u, v) / dot(u, u)) * u));
    ASSERT_FALSE(book.full) << i;
    b.ticks(20);
    ASSERT_LT(b.fastest(), 30) << i;  // pieces fall for two seconds in all
  }
  EXPECT_NEAR(b.mass(), mass + b.model.density * b.state.volume, 1e-9 * mass);
}

TEST(Cuttable, WorkIsScratch) {
  Body a(hung(4, 4, 8)), b(hung(4, 4, 8));
  for (Body* body : {&a, &b}) {
    body->ticks(10);
    body->cut(rectangle({0.01, 0.01, 0.0222}, {0.008, 0.002, 0.002}, {0, 0.05, 0.001}));
  }
  for (int i = 0; i < 20; ++i) {
    b.work.made_for = ~0u;
    for (NodeState& n : b.work.other) n.x = n.vx = std::nanf("");
    for (HalfEdgePack& p : b.work.packs) std::memset(static_cast<void*>(&p), 0xff, sizeof p);
    for (double& m : b.work.mass) m = std::nan("");
    a.ticks(1);
    b.ticks(1);
  }
  core::Hasher one, other;
  add_to_hash(one, a.state);
  add_to_hash(other, b.state);
  EXPECT_EQ(one.value(), other.value());
}

TEST(Cuttable, AllInstructionSetsGiveTheSameBits) {
  const std::string usual = simd_name();
  std::uint64_t first = 0;
  for (const char* name : {"generic", "sse2", "avx2", "avx512"}) {
    if (!set_simd(name)) continue;
    Body b(hung(5, 4, 8));
    b.ticks(20);
    b.cut(rectangle({0.01, 0.01, 0.0222}, {0.05, 0.002, 0.002}, {0, 0.05, 0.001}));
    b.ticks(50);
    core::Hasher h;
    add_to_hash(h, b.state);
    if (first == 0) first = h.value();
    EXPECT_EQ(h.value(), first) << name;
  }
  set_simd(usual);
}

TEST(Cuttable, RefusesWhatIsUnsound) {
  CuttableDescription d = bar(2, 2, 2);
  d.spare_nodes = -1;
  EXPECT_THROW(build(d, 1e-3), std::invalid_argument);
  d = bar(2, 2, 2);
  d.fixed.assign(3, kHeld);
  EXPECT_THROW(build(d, 1e-3), std::invalid_argument);
  d = hung(2, 2, 2);
  std::fill(d.fixed.begin(), d.fixed.end(), std::uint8_t(kFree));
  d.fixed[0] = kHeldX;
  EXPECT_THROW(build(d, 1e-3), std::invalid_argument) << "nothing holds it up";
}

TEST(Cuttable, ANodeWithMoreSpringsThanCutsLeaveRoomForIsRefused) {
  // A fan of wedges around an axis: all meet at its two ends.
  constexpr int n = 200;
  CuttableDescription d;
  d.points = {{0, 0, 0}, {0, 0, 0.05}};
  for (int i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    d.points.push_back({0.05 * std::cos(a), 0.05 * std::sin(a), 0.025});
  }
  for (int i = 0; i < n; ++i) d.cells.push_back({0, 1, 2 + i, 2 + (i + 1) % n});
  for (geometry::Tet& c : d.cells) {
    const auto x = [&](size_t k) { return d.points[size_t(c[k])]; };
    if (dot(x(1) - x(0), cross(x(2) - x(0), x(3) - x(0))) < 0) std::swap(c[2], c[3]);
  }
  d.material = {.youngs_modulus = 5e3, .density = 1000};
  EXPECT_THROW(build(d, 1e-3), std::invalid_argument);
}

}  // namespace
}  // namespace trocar::tissue
