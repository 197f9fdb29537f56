// The step's law: no allocation.
#include <gtest/gtest.h>

#include <trocar/tissue/membrane/membrane.hpp>
#include <trocar/tissue/strand/strand.hpp>

#include "../count_allocations.hpp"
#include "heat_setup.hpp"
#include "test_bodies.hpp"

namespace trocar::tissue {
namespace {

TEST(NoAllocation, InANetworksTickItsCutsOrItsCollapses) {
  const NetworkModel m = build(test::wobbly_block(6, 6, 6), 1e-3);
  NetworkState s = rest_state(m);
  NetworkWork w = make_work(m);
  set_position(m, s, m.nodes - 1, m.rest[0]);
  const NodeLoad load{.node = 100, .k = 500};
  Vec3f reaction;
  std::uint32_t flags = 0;
  const long before = g_allocations;
  for (int t = 0; t < 20; ++t) {
    flags |= advance(m, {&load, 1}, {&reaction, 1}, s, w).flags;
    cut_spring(m, s, 10 * t);
  }
  EXPECT_EQ(g_allocations, before);
  EXPECT_TRUE(flags & StepReport::kInverted);
}

TEST(NoAllocation, InTheTickOfAFilledSheetOrWhenItLeaks) {
  MembraneDescription d;
  d.positions = {{0.01, 0, 0}, {-0.01, 0, 0}, {0, 0.01, 0}, {0, -0.01, 0}, {0, 0, 0.01}, {0, 0, -0.01}};
  d.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  d.thickness = 0.001;
  d.youngs_modulus = 50e3;
  d.density = 1000;
  d.enclosure.kind = Enclosure::liquid;
  d.enclosure.pressure = 100, d.enclosure.bulk = 1e6, d.enclosure.density = 1000;
  d.gravity = {0, 0, -9.81};
  const MembraneModel m = build(d, 1e-3);
  MembraneState s = rest_state(m);
  MembraneWork w = make_work(m);
  std::vector<std::uint8_t> parted(m.triangles.size(), 0);
  const long before = g_allocations;
  bool fine = true;
  for (int t = 0; t < 20; ++t) {
    fine = advance(m, {}, {}, {}, s, w).fine() && fine;
    parted[0] = t == 10;
    tear_bends(m, parted, s);
  }
  EXPECT_EQ(g_allocations, before);
  EXPECT_TRUE(fine);
  EXPECT_EQ(s.enclosure.leaking, 1u);
}

TEST(NoAllocation, InAStrandsTick) {
  StrandDescription d;
  for (int i = 0; i < 12; ++i) d.positions.push_back({0.004 * i, 0, 0.001 * i * i / 12});
  d.radius.assign(11, 0.002);
  d.youngs_modulus = 60e3;
  d.density = 1050;
  d.prescribed.assign(12, 0);
  d.prescribed[0] = d.prescribed[1] = 1;
  const StrandModel m = build(d, 1e-3);
  StrandState s = rest_state(m);
  StrandWork w = make_work(m);
  StrandReaction ends[2];
  const StrandLoad load{.element = 5, .w = 0.5, .k = 100};
  const long before = g_allocations;
  for (int t = 0; t < 20; ++t) {
    EXPECT_TRUE(advance(m, {}, {&load, 1}, ends, {}, s, w).fine());
    if (t == 10) cut_element(s, 7);
  }
  EXPECT_EQ(g_allocations, before);
}

TEST(NoAllocation, WhereCurrentHeatsTissueThatBoilsWakesAndSleeps) {
  test::Operated o(HeatDescription{.bricks = 24, .awake = 16}, test::half_space());
  const long before = g_allocations;
  for (int t = 0; t < 12000; ++t) {
    const Vec3d at{2e-3 * (t / 1000), 0, -0.1e-3};
    o.press({.yellow = false, .blue = t < 6000}, t < 8000 ? test::tip_at(at) : ElectrodeContact{});
  }
  reading(o.m, o.s, BodyId::strand(0), {0, 0, 0});
  EXPECT_EQ(g_allocations, before);
  EXPECT_TRUE(o.flags & HeatReport::kAwakeFull);
  EXPECT_GT(o.boiled, 1e-6);
}

}  // namespace
}  // namespace trocar::tissue
