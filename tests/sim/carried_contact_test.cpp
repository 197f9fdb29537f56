// Bodies that are carried to each other from far away do not pass through each other.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/sim/model/bodies.hpp>

#include "small_scene.hpp"

using namespace trocar;
using namespace trocar::sim;

namespace {

constexpr int kPad = 0, kLoaf = 1;
constexpr double kHigh = 0.09;  // [m] of the loaf above the pad: twice as far as bodies look at each other as drawn

scene::Solid loaf(const char* name, double height, double wide, double stiffness) {
  scene::Solid s;
  s.name = name;
  s.tissue = "flesh";
  for (double x : {-wide, 0.0, wide}) s.sections.push_back({{x, 0, height}, {0, 0.014, 0}, {0, 0, 0.007}, 2});
  s.cell = 0.004;
  s.skin_edge = 0.004;
  s.fine_edge = 0.003;
  s.anchors.push_back({{0, 0, height}, 0.030, stiffness, {}});
  return s;
}

/// A pad that is held; above it a loaf, and a rod beside that, that nothing holds.
Model two_bodies() {
  scene::Description d = small::description();
  d.solids = {loaf("pad", 0, 0.030, 400), loaf("loaf", kHigh, 0.010, 400)};
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

/// How deep a place is in the pad, by the nearest of all its triangles; below 0: outside [m].
double depth_in_pad(const Model& m, const State& s, Vec3d p) {
  const tissue::Skin& skin = m.skin(kPad);
  const tissue::NodeView nodes = nodes_of(m, s, kPad);
  double least = 1e9, depth = 0;
  for (const auto& t : skin.triangles) {
    const Vec3d a = skin_point(nodes, skin, t[0]), b = skin_point(nodes, skin, t[1]), c = skin_point(nodes, skin, t[2]);
    const auto on = geometry::closest_on_triangle(p, a, b, c);
    if (on.distance2 >= least) continue;
    least = on.distance2;
    depth = dot(p - on.point, cross(b - a, c - a)) < 0 ? std::sqrt(least) : -std::sqrt(least);
  }
  return depth;
}

struct Ends {
  double loaf = -1, rod = -1;  ///< deepest in the pad at the end [m]
  double loaf_high = 0;        ///< its lowest vertex [m]
};
Ends let_fall(const Model& m) {
  State s = initial_state(m);
  Work w = make_work(m);
  for (int tick = 0; tick < 2500; ++tick) EXPECT_TRUE(step(m, m.start, s, w).fine()) << tick;
  Ends ends;
  ends.loaf_high = 1;
  const tissue::NodeView nodes = nodes_of(m, s, kLoaf);
  for (int v = 0; v < m.skin(kLoaf).size(); ++v) {
    const Vec3d p = skin_point(nodes, m.skin(kLoaf), v);
    ends.loaf = std::max(ends.loaf, depth_in_pad(m, s, p));
    ends.loaf_high = std::min(ends.loaf_high, p.z);
  }
  for (const Vec3d& p : s.strands[0].x)
    ends.rod = std::max(ends.rod, depth_in_pad(m, s, p) + m.strand_bodies[0].model.radius[0]);
  return ends;
}

TEST(CarriedContact, WhatFallsOnABodyThatWasDrawnFarAwayRestsOnIt) {
  const Model m = two_bodies();
  ASSERT_FALSE(m.carried_pairs.empty());
  const Ends ends = let_fall(m);
  RecordProperty("loaf_mm", std::to_string(1e3 * ends.loaf));
  RecordProperty("rod_mm", std::to_string(1e3 * ends.rod));
  EXPECT_LT(ends.loaf, 0.001);
  EXPECT_GT(ends.loaf_high, -0.004) << "it lies on the pad, not below it";
  EXPECT_LT(ends.rod, 0.001);
}

TEST(CarriedContact, WithoutItTheyPassThroughEachOther) {
  Model m = two_bodies();
  m.carried_pairs.clear();
  EXPECT_LT(let_fall(m).loaf_high, -0.02);
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
