// Bodies that are carried to each other from far away do not pass through each other.
#include <gtest/gtest.h>

#include <trocar/sim/model/bodies.hpp>

#include "interpenetration.hpp"
#include "small_scene.hpp"
#include "watch.hpp"

using namespace trocar;
using namespace trocar::sim;

namespace {

constexpr int kPad = 0, kLoaf = 1;
constexpr double kHigh = 0.09;  // [m] of the loaf above the pad: twice as far as bodies look at each other as drawn

/// @param across      [m] half width in y
/// @param squareness  2: round; more: with a flat top
scene::Solid loaf(const char* name, double height, double wide, double across, double squareness) {
  scene::Solid s;
  s.name = name;
  s.tissue = "flesh";
  for (double x : {-wide, 0.0, wide}) s.sections.push_back({{x, 0, height}, {0, across, 0}, {0, 0, 0.007}, squareness});
  s.cell = 0.004;
  s.skin_edge = 0.004;
  s.fine_edge = 0.003;
  s.anchors.push_back({{0, 0, height}, 0.050, 400, {}});
  return s;
}

/// A pad that is held; above it a loaf, and a rod beside that, that nothing holds.
Model two_bodies() {
  scene::Description d = small::description();
  d.solids = {loaf("pad", 0, 0.030, 0.030, 8), loaf("loaf", kHigh, 0.010, 0.014, 8)};
  scene::Strand rod = small::cord();
  rod.centreline = {{-0.006, 0, kHigh + 0.03}, {0.0, 0, kHigh + 0.03}, {0.012, 0, kHigh + 0.03}};
  d.strands = {rod};
  d.membranes.clear(), d.pouches.clear(), d.vessels.clear(), d.walls.clear(), d.marks.clear();
  d.fluids.reset();
  Model m = scene::compile(d);
  m.solids[kLoaf].anchors.clear();
  m.strands[0].start.kind = m.strands[0].end.kind = StrandEndModel::free;
  m.strand_bodies[0].model.prescribed_nodes.clear();
  std::fill(m.strand_bodies[0].model.prescribed.begin(), m.strand_bodies[0].model.prescribed.end(), std::uint8_t(0));
  std::fill(m.strand_bodies[0].model.foundation.begin(), m.strand_bodies[0].model.foundation.end(), 0);
  return m;
}

/// The scene when all has fallen.
State let_fall(const Model& m) {
  State s = initial_state(m);
  Work w = make_work(m);
  for (int tick = 0; tick < 1500; ++tick) EXPECT_TRUE(step(m, m.start, s, w).fine()) << tick;
  return s;
}

/// The lowest vertex of the loaf [m].
double height_of_loaf(const Model& m, const State& s) {
  double least = 1;
  const tissue::NodeView nodes = nodes_of(m, s, kLoaf);
  for (int v = 0; v < m.skin(kLoaf).size(); ++v) least = std::min(least, skin_point(nodes, m.skin(kLoaf), v).z);
  return least;
}

/// A rod high above, across a cord that is held at both ends, with or without a membrane that hangs level between the
/// cord and space. Nothing holds the rod.
Model rod_above(bool membrane) {
  scene::Description d = small::description();
  scene::Strand rod = small::cord();
  rod.name = "falling";
  rod.centreline = {{0.037, -0.010, kHigh}, {0.037, 0.010, kHigh}, {0.037, 0.030, kHigh}};
  scene::Strand cord = small::cord();
  for (Vec3d& p : cord.centreline) p.y = membrane ? -0.005 : 0.010;
  d.strands = {cord, rod};
  d.membranes.clear();
  if (membrane) {
    scene::Membrane m = small::fold();
    m.strand = "cord";
    m.from = 0.015, m.to = 0.060;
    m.base = {{0.015, 0.028, 0}, {0.037, 0.028, 0}, {0.060, 0.028, 0}};
    m.base_on.clear();
    d.membranes = {m};
  }
  d.solids.clear(), d.pouches.clear(), d.vessels.clear(), d.walls.clear(), d.marks.clear();
  d.fluids.reset();
  Model m = scene::compile(d);
  m.strands[1].start.kind = m.strands[1].end.kind = StrandEndModel::free;
  tissue::StrandModel& free = m.strand_bodies[1].model;
  free.prescribed_nodes.clear();
  std::fill(free.prescribed.begin(), free.prescribed.end(), std::uint8_t(0));
  std::fill(free.foundation.begin(), free.foundation.end(), 0);
  return m;
}

/// The least height of the falling rod's middle above the cord, or above the membrane's lowest node [m].
double least_height(const Model& m) {
  State s = initial_state(m);
  Work w = make_work(m);
  double least = 1;
  for (int tick = 0; tick < 300; ++tick) {  // it falls for 135 ticks
    EXPECT_TRUE(step(m, m.start, s, w).fine()) << tick;
    const std::vector<Vec3d>&rod = s.strands[1].x, &cord = s.strands[0].x;
    double below = cord[cord.size() / 2].z;
    for (size_t i = 0; i < m.membranes.size(); ++i)
      for (int n = 0; n < m.membranes[i].sheet.nodes(); ++n)
        below = std::min(below, position(m.membranes[i].sheet.network, s.membranes[i].network, n).z);
    least = std::min(least, rod[rod.size() / 2].z - below);
  }
  return least;
}

TEST(CarriedContact, ARodThatFallsOnAnotherOneThatWasDrawnFarAwayStaysAboveIt) {
  Model m = rod_above(false);
  ASSERT_EQ(m.strand_pairs.size(), 1u);
  EXPECT_GT(least_height(m), 0.001) << "[m], of 4 that both are thick; it arrives at 1.3 m/s";
  m.strand_pairs.clear();
  EXPECT_LT(least_height(m), -0.02);
}

TEST(CarriedContact, ARodThatFallsOnAMembraneStaysOnTheSideFromWhichItCame) {
  Model m = rod_above(true);
  EXPECT_GT(least_height(m), 0.001) << "[m]";
  m.carried_pairs.clear();
  m.strand_pairs.clear();
  EXPECT_LT(least_height(m), 0.001);
}

TEST(CarriedContact, WhatFallsOnABodyThatWasDrawnFarAwayRestsOnIt) {
  const Model m = two_bodies();
  ASSERT_FALSE(m.carried_pairs.empty());
  const State end = let_fall(m);
  const Interpenetration start = measure(m, initial_state(m)), now = measure(m, end);
  for (const Growth& g : deeper_than(now, start, 0.001)) ADD_FAILURE() << text_of(now, g);
  EXPECT_GT(height_of_loaf(m, end), -0.004) << "it lies on the pad, not below it";
}

TEST(CarriedContact, WithoutItTheyPassThroughEachOther) {
  Model m = two_bodies();
  m.carried_pairs.clear();
  EXPECT_LT(height_of_loaf(m, let_fall(m)), -0.02);
}

/// A bar that can be cut, high above the pad, held at its left end.
Model bar_above_pad() {
  scene::Description d = small::description();
  scene::Solid bar = small::bar();
  bar.sections.clear();
  for (double x : {-0.034, -0.019, -0.004, 0.011})
    bar.sections.push_back({{x, 0, kHigh}, {0, 0.003, 0}, {0, 0, 0.004}, 2});
  bar.anchors = {{{-0.036, 0, kHigh}, 0.016, 0, {}}};
  d.solids = {loaf("pad", 0, 0.030, 0.030, 8), bar};
  d.strands.clear(), d.membranes.clear(), d.pouches.clear(), d.vessels.clear(), d.walls.clear(), d.marks.clear();
  d.fluids.reset();
  return scene::compile(d);
}

TEST(CarriedContact, APieceThatIsCutOffFallsOnABodyAndRestsOnIt) {
  const Model m = bar_above_pad();
  State s = initial_state(m);
  Work w = make_work(m);
  const tissue::CuttableModel& bar = m.cuttables[0].body;
  Watch watch(m, s, "bar", {"bar", "pad"});
  tissue::CuttableWork scratch = tissue::make_work(bar);
  tissue::cut(bar, geometry::square_blade({-0.012, 0, kHigh}, {1, 0, 0}, 0.02), s.cuttables[0], scratch);
  ASSERT_EQ(scratch.parts, 2);
  const auto height_at = [&](double x) {  // of the node that was drawn there
    int best = 0;
    for (int n = 0; n < bar.own_nodes; ++n)
      if (length(bar.drawn.rest[size_t(n)] - Vec3d{x, 0, kHigh}) <
          length(bar.drawn.rest[size_t(best)] - Vec3d{x, 0, kHigh}))
        best = n;
    return tissue::position(bar, s.cuttables[0], best).z;
  };
  double lowest = 1;
  for (int tick = 0; tick < 1200; ++tick) {
    ASSERT_TRUE(step(m, m.start, s, w).fine()) << tick;
    if (s.tick % Watch::kEvery == 0) watch.look(s);
    lowest = std::min(lowest, height_at(0));
  }
  EXPECT_EQ(watch.found(), "");
  EXPECT_LT(lowest, 0.020) << "[m] it has fallen";
  EXPECT_GT(lowest, 0.004) << "[m] onto the pad, which is 7 mm high";
  EXPECT_NEAR(height_at(-0.034), kHigh, 0.003) << "[m] the rest hangs as it did";
}

TEST(CarriedContact, BodiesThatStayWhereTheyWereDrawnRememberNothing) {
  const Model& m = small::model();
  State s = initial_state(m);
  Work w = make_work(m);
  for (int tick = 0; tick < 100; ++tick) step(m, m.start, s, w);
  for (const std::vector<std::int32_t>& pair : s.carried)
    for (const std::int32_t vertex : pair) ASSERT_EQ(vertex, -1);
}

}  // namespace
