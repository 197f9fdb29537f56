// Fluid in a lattice: nothing is lost, it makes as much room as it is, and it lifts the surface as the closed form of
// an expanding point below a free surface has it [Mogi 1958; Mindlin & Cheng 1950].
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/tissue/infusion/infusion.hpp>
#include <trocar/tissue/network/lattice_springs.hpp>

#include "validation.hpp"

namespace trocar::tissue {
namespace {

using test::expect_within;
using test::kPi;

constexpr double kE = 10e3, kNu = 0.25, kPicolitre = 1e-15, kTick = 1e-3;

/// n^3 cells; z = 0 is the surface, the tissue is below, x = 0 and y = 0 are planes of symmetry.
struct InfusedQuarter {
  int n;
  double h, depth, volume;
  BoxLattice box;
  NetworkModel network;
  NetworkState state;
  NetworkWork work;
  InfusionModel model;
  InfusionState fluid;
  InfusionWork scratch;

  /// @param of  volume that flows into all four quarters [m^3]
  InfusedQuarter(int cells, double side, double at, double of)
      : n(cells),
        h(side / cells),
        depth(at),
        volume(of),
        box(box_lattice(cells, cells, cells, h, {0, 0, -side})),
        network(build(description(), kTick)),
        state(rest_state(network)),
        work(make_work(network)),
        model(infusion_of(network, kE)),
        fluid(dry(model)),
        scratch(make_work(model)) {
    for (int i = 0; i < network.nodes; ++i)
      if (network.fixed[size_t(i)] == kHeld)
        set_position(network, state, i, network.rest[size_t(i)] + far(network.rest[size_t(i)]));
  }

  NetworkDescription description() const {
    NetworkDescription d = lattice_network(box.corners, box.cells, {}, {.youngs_modulus = kE, .density = 1000}).network;
    d.fixed.assign(d.positions.size(), kFree);
    const double side = n * h, close = 1e-9 * side;
    for (size_t i = 0; i < d.fixed.size(); ++i) {
      const Vec3d p = d.positions[i];
      if (p.x < close) d.fixed[i] |= kHeldX;
      if (p.y < close) d.fixed[i] |= kHeldY;
      if (p.x > side - close || p.y > side - close || p.z < -side + close) d.fixed[i] = kHeld;
    }
    d.global_damping = 5 / side;
    for (SpringDescription& e : d.springs) e.damping = 2e-5 * e.k;
    return d;
  }
  /// Displacement around an expanding point [Mindlin & Cheng 1950]; z upwards.
  Vec3d far(Vec3d p) const {
    const double z = -p.z, c = depth, a = volume / (4 * kPi), r2 = p.x * p.x + p.y * p.y;
    const double R1 = std::sqrt(r2 + (z - c) * (z - c)), R2 = std::sqrt(r2 + (z + c) * (z + c));
    const double i1 = 1 / (R1 * R1 * R1), i2 = 1 / (R2 * R2 * R2), i5 = i2 / (R2 * R2), k = 3 - 4 * kNu;
    const double out = a * (i1 + k * i2 - 6 * z * (z + c) * i5);
    const double down =
        a * ((z - c) * i1 + k * (z + c) * i2 - 6 * z * (z + c) * (z + c) * i5 - 2 * i2 * (k * (z + c) - z));
    return {out * p.x, out * p.y, -down};
  }
  double mogi(double r) const { return (1 - kNu) * volume * depth / (kPi * std::pow(r * r + depth * depth, 1.5)); }

  NodeView nodes() const { return view_of(network, state); }
  std::int64_t bring(double share, double sigma) {
    const auto amount = std::int64_t(share * volume / 4 / kPicolitre);
    const std::int64_t in = infuse(model, nodes(), {0, 0, -depth}, amount, sigma, true, 1, fluid, scratch);
    EXPECT_EQ(in, amount);
    return in;
  }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) {
      swell(model, network, state.nodes, kTick, fluid, scratch, state.tet_phase);
      ASSERT_TRUE(advance(network, {}, {}, state, work, nullptr, Hands::off, {}, scratch.force).fine());
    }
  }
  double lifted(int i) const {
    const int node = box.corner(i, 0, n);
    return position(network, state, node).z - network.rest[size_t(node)].z;
  }
};

TEST(Infusion, LiftsTheSurfaceAsAnExpandingPointBelowItDoes) {  // [injected volume]
  // 0.1 mL at 15 mm: (1 - nu) dV d / (pi (r^2 + d^2)^1.5)
  // A wide bell lifts less: it is near the surface itself.
  InfusedQuarter q(24, 0.060, 0.015, 0.1e-6);
  for (int i = 0; i < 20; ++i) {
    q.bring(0.05, 2.5e-3);
    q.ticks(10);
  }
  q.ticks(900);
  double worst = 0;
  for (int i = 0; i <= 8; ++i) worst = std::max(worst, std::fabs(q.lifted(i) / q.mogi(i * q.h) - 1));
  expect_within("injected volume, uplift above it and up to 20 mm beside", "f32", worst, 0.1);
}

TEST(Infusion, MakesAsMuchRoomAsHasFlowedIn) {  // [injected volume]
  InfusedQuarter q(16, 0.048, 0.012, 0.4e-6);
  q.bring(1, 5e-3);
  q.ticks(1200);
  double wanted = 0, stands = 0;
  for (size_t r = 0; r < q.model.room.size(); ++r) {
    if (double(q.fluid.volume[r]) * kPicolitre < 0.02 * double(q.model.room[r])) continue;
    wanted += double(q.fluid.volume[r]) * kPicolitre;
    stands += double(q.scratch.now[r]) - double(q.model.room[r]);
  }
  expect_within("injected volume, room that it makes where it lies", "f32", std::fabs(stands / wanted - 1), 0.02);
}

TEST(Infusion, NeedsThePressureOfAnExpandingRegionInASkeletonOfSprings) {  // [pore pressure]
  // P = (K + 4 G / 3) theta, far from all surfaces. Cells of 2.3 mm; with 3 mm it is 11 % off in the middle, 1 % in
  // all.
  InfusedQuarter q(26, 0.060, 0.030, 0.05e-6);
  q.bring(1, 5e-3);
  q.ticks(1500);
  const double bulk = kE / (3 * (1 - 2 * kNu)), shear = kE / (2 * (1 + kNu));
  double is = 0, should = 0;  // node by node it is uneven, as the cells' tetrahedra are
  for (size_t r = 0; r < q.model.room.size(); ++r) {
    const double room = double(q.model.room[r]), theta = double(q.fluid.volume[r]) * kPicolitre / std::max(room, 1e-30);
    if (theta < 0.01) continue;
    is += room * double(q.fluid.pressure[r]);
    should += room * (bulk + 4 * shear / 3) * theta;
  }
  expect_within("pore pressure, mean where theta is above 0.01", "f32", std::fabs(is / should - 1), 0.1);
}

TEST(Infusion, NoPressureIsHigherThanThatAtWhichACavityOpens) {
  InfusedQuarter q(12, 0.036, 0.012, 12e-6);
  infuse(q.model, q.nodes(), {0, 0, -0.012}, 3'000'000'000, 6e-3, false, 1, q.fluid, q.scratch);
  q.ticks(1500);
  float most = 0;
  for (const float p : q.fluid.pressure) most = std::max(most, p);
  EXPECT_FLOAT_EQ(most, float(5 * kE / 6));
}

/// Severs the springs across the plane x = `at`.
void tear(InfusedQuarter& q, double at) {
  for (int s = 0; s < q.network.springs; ++s) {
    const auto x = [&](int end) { return q.network.rest[size_t(q.network.spring_nodes[size_t(2 * s + end)])].x; };
    if ((x(0) < at) != (x(1) < at)) cut_spring(q.network, q.state, s);
  }
}

TEST(Infusion, WhereTissueHasTornThereIsNoPressureAndItRunsOut) {  // [torn cell]
  InfusedQuarter q(12, 0.036, 0.012, 2e-6);
  q.bring(1, 5e-3);
  q.ticks(500);
  EXPECT_EQ(q.scratch.tears, 0);
  tear(q, 0.0045);
  q.ticks(600);
  ASSERT_EQ(q.scratch.tears, 1);
  float torn = 0, whole = 0;
  for (size_t r = 0; r < q.model.room.size(); ++r)
    (q.scratch.torn[r] ? torn : whole) = std::max(q.scratch.torn[r] ? torn : whole, q.fluid.pressure[r]);
  EXPECT_EQ(torn, 0);
  EXPECT_GT(whole, 100);
  const std::int64_t before = q.fluid.total;
  std::int64_t out = 0;
  for (int i = 0; i < 2000; ++i) {
    std::int32_t row = -1;
    out += drain_tears(0.01, q.scratch, q.fluid, row);
  }
  EXPECT_EQ(q.fluid.total, before - out);
  EXPECT_GT(out, before / 10);
  for (size_t r = 0; r < q.model.room.size(); ++r) EXPECT_TRUE(!q.scratch.torn[r] || q.fluid.volume[r] == 0) << r;
}

TEST(Infusion, StretchesNoCellFurtherThanItsFluidAccountsForWhateverHoldsIt) {  // [torn cell]
  InfusedQuarter q(10, 0.030, 0.006, 20e-6);
  for (int s = 0; s < q.network.springs; ++s)  // a body of threads
    if (s % 4 != 0) set_spring_scale(q.network, q.state, s, 0.02f);
  for (int i = 0; i < 200; ++i) {
    infuse(q.model, q.nodes(), {0, 0, -0.006}, 20'000'000, 8e-3, false, 1, q.fluid, q.scratch);
    q.ticks(10);
  }
  double most = 0;
  for (const TetRest& cell : q.network.tets) {
    const auto at = [&](int k) {
      const NodeState& n = q.state.nodes[size_t(cell.row[k])];
      return Vec3d{double(n.x), double(n.y), double(n.z)};
    };
    const Vec3d o = at(0);
    most = std::max(most, dot(at(1) - o, cross(at(2) - o, at(3) - o)) / double(cell.rest6));
  }
  std::printf("a cell is %.2f times as large at most\n", most);
  EXPECT_GT(most, 1.2);
  EXPECT_LT(most, 1.5 * double(kBursts)) << "it swings beyond that";
}

TEST(Infusion, KeepsEveryPicolitreThroughTenThousandRandomActs) {
  InfusedQuarter q(8, 0.032, 0.010, 1e-6);
  core::Random random(7);
  std::int64_t in = 0, out = 0;
  for (int i = 0; i < 10'000; ++i) {
    const Vec3d at{random.uniform(0, 0.03), random.uniform(0, 0.03), random.uniform(-0.03, 0)};
    const auto amount = std::int64_t(random.uniform(0, 1e8));
    switch (i % 3) {
      case 0:
        in += infuse(q.model, q.nodes(), at, amount, random.uniform(1e-3, 1e-2), i % 2 == 0, std::uint32_t(i) + 1,
                     q.fluid, q.scratch);
        break;
      case 1:
        out += let_out(q.model, q.nodes(), at, amount, random.uniform(1e-3, 1e-2), q.fluid, q.scratch);
        break;
      default:
        out += absorb(random.uniform(0, 0.01), q.fluid);
    }
    std::int64_t sum = 0;
    for (const std::int64_t v : q.fluid.volume) {
      ASSERT_GE(v, 0);
      sum += v;
    }
    ASSERT_EQ(sum, in - out) << i;
    ASSERT_EQ(q.fluid.total, sum);
  }
  EXPECT_GT(in, out);
  EXPECT_GT(out, 0);
}

TEST(Infusion, AFullTissueTakesNoMore) {
  InfusedQuarter q(8, 0.032, 0.010, 1e-6);
  std::int64_t in = 0;
  for (int i = 0; i < 100; ++i)
    in += infuse(q.model, q.nodes(), {0, 0, -0.010}, 1'000'000'000, 0.05, false, 1, q.fluid, q.scratch);
  EXPECT_LE(double(in) * kPicolitre, 1.001 * kFullest * 0.032 * 0.032 * 0.032);
  EXPECT_EQ(infuse(q.model, q.nodes(), {0, 0, -0.010}, 1'000'000'000, 0.05, false, 1, q.fluid, q.scratch), 0);
}

TEST(Infusion, BlanchesAfterTwentySecondsWhollyAfterNinetyAndForHalfAnHour) {
  EXPECT_EQ(blanched(1, 20), 0);
  EXPECT_NEAR(blanched(1, 55), 0.5, 1e-12);
  EXPECT_EQ(blanched(1, 90), 1);
  EXPECT_EQ(blanched(1, 1800), 1);
  EXPECT_LT(blanched(1, 2000), 1);
  EXPECT_EQ(blanched(1, 2400), 0);
  EXPECT_EQ(blanched(kDoseFelt, 90), 0);
}

TEST(Infusion, TheMiddleOfAFreshGaussianIsAThirdOfTheTissue) {
  const double volume = 5e-6, sigma = spread_of(volume);
  EXPECT_NEAR(volume / (std::pow(2 * kPi, 1.5) * sigma * sigma * sigma), kMeant, 1e-9);
  EXPECT_EQ(spread_of(1e-12), kNarrowest);
}

}  // namespace
}  // namespace trocar::tissue
