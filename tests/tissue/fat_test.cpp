// Lobules and septa: how stiff and strong they are, what heat does to them, and that what is lost is booked.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/tick.hpp>
#include <trocar/tissue/fat/fat.hpp>

using namespace trocar;
using namespace trocar::tissue;

namespace {

using core::kTick;

constexpr double kSpacing = 0.0025;

/// A face-centred lattice, `n` half cubes along each edge.
FatDescription block(int nx, int ny, int nz) {
  FatDescription d;
  d.spacing = kSpacing;
  d.material.serosa = 0;
  const double half = kSpacing / std::sqrt(2.0);
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = (j + k) % 2; i < nx; i += 2) d.lobules.push_back(half * Vec3d{double(i), double(j), double(k)});
  d.free.assign(d.lobules.size(), 0);
  d.held.assign(d.lobules.size(), 0);
  return d;
}

/// One lobule held in space, one that is drawn away from it along x.
struct Pair {
  FatModel model;
  FatState state;
  FatWork work;
  double drawn = kSpacing;

  explicit Pair(FatMaterial material = {}, bool serosa = false) {
    FatDescription d;
    d.spacing = kSpacing;
    d.material = material;
    if (!serosa) d.material.serosa = 0;
    d.lobules = {{0, 0, 0}, {kSpacing, 0, 0}};
    d.free = {serosa, serosa};
    d.held = {1, 0};
    model = build(d, kTick);
    state = rest_state(model);
    work = make_work(model);
  }
  /// @return the pull on the second lobule [N]
  double draw(double way) {
    drawn += way;
    NodeLoad load;
    load.node = 1;
    load.k = 2000;
    load.d = 0.1f;
    load.x0 = {float(drawn), 0, 0};
    Vec3f force;
    EXPECT_TRUE(advance(model, {&load, 1}, {&force, 1}, state, work).fine());
    return double(force.x);
  }
  double septum_stiffness() const { return spring_stiffness(model.network, 0); }
};

struct Pull {
  double peak = 0, work = 0, after = 0;  ///< [N], [J], [N]
};
Pull draw_out(Pair& pair, double speed, double far) {
  Pull p;
  const double way = speed * kTick;
  for (double x = 0; x < far; x += way) {
    p.after = pair.draw(way);
    p.peak = std::max(p.peak, p.after);
    p.work += p.after * way;
  }
  return p;
}

}  // namespace

// Along a cube's edge a face-centred lattice of central springs has two thirds of its mean modulus: C11 = 2 C12 = 2 C44
// [Born & Huang 54], E = (C11 - C12)(C11 + 2 C12) / (C11 + C12).
TEST(Fat, ABlockIsAsStiffAlongAnEdgeAsItsLatticeIs) {
  FatDescription d = block(9, 9, 17);
  const double half = kSpacing / std::sqrt(2.0), top = 16 * half - 1e-6;
  std::vector<NodeLoad> loads;
  for (std::size_t i = 0; i < d.lobules.size(); ++i) {
    d.held[i] = d.lobules[i].z < 1e-6;
    if (d.lobules[i].z < top) continue;
    NodeLoad load;
    load.node = int(i);
    loads.push_back(load);
  }
  const double side = 9 * half, stress = 100, force = stress * side * side / double(loads.size());
  for (NodeLoad& load : loads) load.f0 = {0, 0, float(force)};
  const FatModel m = build(d, kTick);
  FatState s = rest_state(m);
  FatWork w = make_work(m);
  std::vector<Vec3f> reactions(loads.size());
  for (int i = 0; i < 3000; ++i) ASSERT_TRUE(advance(m, loads, reactions, s, w).fine());
  double stretched = 0;
  for (const NodeLoad& load : loads) stretched += (position(m, s, load.node).z - 16 * half) / double(loads.size());
  const double young = stress / (stretched / (16 * half));
  EXPECT_NEAR(young, d.material.young * 2 / 3, 0.12 * young) << "its free faces are softer";
}

TEST(Fat, ASeptumBearsMostAtTheStrainThatIsDeclaredAndIsGoneAtTheOther) {
  Pair pair;
  const FatMaterial& material = pair.model.material;
  const double expected = pair.septum_stiffness() * material.yields * kSpacing;
  const Pull p = draw_out(pair, 0.004, 1.5 * material.opens * kSpacing);
  EXPECT_NEAR(p.peak, expected, 0.05 * expected);
  EXPECT_NEAR(p.work, 0.5 * expected * material.opens * kSpacing, 0.06 * p.work) << "the area of the triangle";
  EXPECT_EQ(holding(pair.model, pair.state, 0), 0);
}

TEST(Fat, WhatASeptumTakesDoesNotDependOnHowFastItIsDrawn) {
  Pair slow, quick;
  const double far = 1.5 * slow.model.material.opens * kSpacing;
  const Pull a = draw_out(slow, 0.002, far), b = draw_out(quick, 0.01, far);
  EXPECT_NEAR(a.work, b.work, 0.1 * a.work);
}

TEST(Fat, NoSeptumHeals) {
  Pair pair;
  draw_out(pair, 0.004, 0.9 * pair.model.material.opens * kSpacing);
  const double held = holding(pair.model, pair.state, 0);
  EXPECT_GT(held, 0);
  EXPECT_LT(held, 0.5);
  while (pair.drawn > kSpacing) pair.draw(-4e-6);
  for (int i = 0; i < 500; ++i) pair.draw(0);
  EXPECT_EQ(holding(pair.model, pair.state, 0), held);
}

TEST(Fat, ACoagulatedSeptumBearsAFifth) {
  Pair whole, cooked;
  const double far = 1.5 * whole.model.material.opens * kSpacing;
  warm(cooked.model, 1, 0.5 * heat_to_go(cooked.model) * 0.3, cooked.state);
  ASSERT_TRUE(cooked.state.lobules[1].coagulated());
  const double a = draw_out(whole, 0.004, far).peak, b = draw_out(cooked, 0.004, far).peak;
  EXPECT_NEAR(b / a, kCoagulatedStrength, 0.05);
}

TEST(Fat, SerosaHoldsSeveralTimesMoreUntilItTears) {
  Pair bare({}, false), covered({}, true);
  const double a = draw_out(bare, 0.004, 2 * kSpacing).peak, b = draw_out(covered, 0.004, 2 * kSpacing).peak;
  EXPECT_GT(b, 5 * a);
  EXPECT_EQ(holding(covered.model, covered.state, 0), 0);
}

TEST(Fat, WhatBoilsAwayIsBooked) {
  const FatDescription d = block(4, 4, 4);
  const FatModel m = build(d, kTick);
  FatState s = rest_state(m);
  EXPECT_EQ(warm(m, 3, 0.999 * heat_to_go(m), s) + warm(m, 3, 0.0005 * heat_to_go(m), s), s.lobules[3].boiled);
  EXPECT_FALSE(s.lobules[3].gone());
  const double boiled = s.lobules[3].boiled + warm(m, 3, 0.01 * heat_to_go(m), s);
  EXPECT_TRUE(s.lobules[3].gone());
  EXPECT_NEAR(boiled, m.material.water * m.mass, 1e-12 * m.mass) << "no more water than there was";
  EXPECT_EQ(s.gone, 1);
  EXPECT_EQ(volume_gone(m, s), m.volume);
  EXPECT_EQ(mass_gone(m, s), m.mass);
  for (int i = 0; i < m.septa(); ++i)
    if (septum_end(m, i, 0) == 3 || septum_end(m, i, 1) == 3) {
      EXPECT_EQ(holding(m, s, i), 0);
    }
  EXPECT_EQ(warm(m, 3, 1, s), 0) << "and nothing comes of it any more";
}

TEST(Fat, ABladePartsWhatItPassesAndNothingElse) {
  const FatDescription d = block(6, 6, 6);
  const FatModel m = build(d, kTick);
  FatState s = rest_state(m);
  const double half = kSpacing / std::sqrt(2.0), height = 2.5 * half;
  const geometry::Blade blade = geometry::square_blade({2.5 * half, 2.5 * half, height}, {0, 0, 1}, 10 * half);
  int across = 0;
  for (int i = 0; i < m.septa(); ++i) {
    const double a = position(m, s, septum_end(m, i, 0)).z, b = position(m, s, septum_end(m, i, 1)).z;
    across += (a > height) != (b > height);
  }
  EXPECT_EQ(sever(m, geometry::BladePlane(blade), s), across);
  EXPECT_EQ(s.severed, across);
  for (int i = 0; i < m.septa(); ++i) {
    const double a = position(m, s, septum_end(m, i, 0)).z, b = position(m, s, septum_end(m, i, 1)).z;
    EXPECT_EQ(holding(m, s, i) > 0, (a > height) == (b > height));
  }
}
