// Grasping in the whole tick: jaws that close on tissue hold it, feel it, and slip where friction ends.
#include <algorithm>

#include <gtest/gtest.h>

#include "../sim/small_scene.hpp"
#include "few_bodies.hpp"
#include "straight_tube.hpp"

using namespace trocar;
using namespace trocar::interactions;
using small::kGrasper;
using small::kTube;

namespace {

constexpr double kHoldStiffness = 1200;  // [N/m] of a held point: what a pull shows as a gap in the grip

/// The tip when the tube, at x, lies `inside` from the hinge of the vertical grasper.
Vec3d tip_around(double x, double inside = 0.012) { return {x, 0, -(0.022 - inside)}; }

/// The small scene with the grasper straight above x and the tube between its closed jaws.
struct Grip : small::Table {
  Vec3d tip;
  explicit Grip(const sim::Model& m = small::model(), double handle = 0.95) : Table(m), tip(tip_around(0.055)) {
    carry(kGrasper, {0.055, 0, 0.04}, tip, 0.2);
    close_slowly(kGrasper, handle, 400);
    steps(200);
  }
  void lift(Vec3d by, double speed = 0.05) {
    carry(kGrasper, tip, tip + by, speed);
    tip += by;
    steps(700);
  }
  Bodies bodies() { return {model, state, &work, {&model.objects, &state.objects, &work.objects}}; }
};

sim::Model with_grasper(double pinch, double friction) {
  scene::Description d = small::description();
  for (scene::Instrument& i : d.instruments)
    if (i.name == "grasper") {
      i.pinch_max = pinch;
      i.friction = friction;
    }
  return scene::compile(d);
}

/// A linkage that closes quickly first: 1 - 1.4 h + 0.4 h^2.
LinkageModel quick_linkage() {
  LinkageModel l;
  l.there = true;
  for (int k = 0; k <= kLinkageSteps; ++k) {
    const double h = double(k) / kLinkageSteps;
    l.aperture[k] = (1 - h) * (1 - 0.4 * h);
    l.leverage[k] = 0.6 / (1.4 - 0.8 * h);
  }
  return l;
}

TEST(Grasp, ALinkageSaysHowFarJawsGoAndHowHardTheyPinch) {
  sim::Model m = with_grasper(20, 1.67);
  for (ToolModel& tool : m.hands[kGrasper].rack) tool.linkage = quick_linkage();
  {
    small::Table t(m);
    t.close_slowly(kGrasper, 0.5, 200);
    t.steps(200);
    EXPECT_NEAR(t.tool(kGrasper).aperture, 0.4, 1e-4) << "nothing between them";
  }
  const Grip g(m, 1);
  const ToolState& tool = g.tool(kGrasper);
  ASSERT_GT(tool.holds, 0);
  const double stop = tool.aperture, left = 1 - handle_of(quick_linkage(), stop);
  EXPECT_GT(stop, 0.02);
  EXPECT_NEAR(tool.pinch, 20 * leverage_at(quick_linkage(), stop) * std::min(1.0, left / std::max(left, 0.05)), 1e-9);
  EXPECT_LT(leverage_at(quick_linkage(), stop), 1);
}

TEST(Grasp, ClosingJawsHoldWhatLiesBetweenThem) {
  const Grip g;
  const ToolState& tool = g.tool(kGrasper);
  ASSERT_GT(tool.holds, 0);
  for (int i = 0; i < tool.holds; ++i) EXPECT_EQ(tool.hold[i].at.body, BodyId::strand(kTube));
  EXPECT_EQ(g.count(sim::Event::grasped), 1);
  EXPECT_EQ(g.count(sim::Event::released), 0);
  // At 56 mm of arc length: the strand begins at x = -1 mm.
  const double s = arc_at(g.model.strand_bodies[kTube], place_on_rod(tool.hold[0].at));
  EXPECT_NEAR(s, 0.056, 0.003);
}

TEST(Grasp, WhatCanGripHoldsAndNothingElseDoes) {
  for (const KindOfTool& kind : kToolKinds) {
    scene::Description d = small::description();
    for (scene::Instrument& i : d.instruments)
      if (i.name == "grasper") i.kind = kind.kind;
    const sim::Model model = scene::compile(d);
    EXPECT_EQ(Grip(model).tool(kGrasper).holds > 0, kind.can.grip) << kind.name;
  }
}

TEST(Grasp, TissueKeepsTheJawsApartAndIsPinched) {
  const Grip g;
  const ToolState& tool = g.tool(kGrasper);
  EXPECT_GT(tool.aperture, 1 - tool.handle);
  const double gap = 2 * g.work.shapes[kGrasper].half_opening(double(tool.hold[0].local[2]));
  EXPECT_NEAR(gap, 0.7 * 2 * small::kTubeRadius, 2e-4) << "squeezed to 0.7 of its diameter";
  EXPECT_GT(tool.pinch, 5);
  EXPECT_LE(tool.pinch, g.model.placed(kGrasper).pinch_max);
}

TEST(Grasp, ClosingBesideTheTissueHoldsNothing) {
  small::Table t(small::model());
  t.carry(kGrasper, {0.055, 0, 0.04}, {0.055, 0, 0.020}, 0.2);
  t.close_slowly(kGrasper, 1, 400);
  EXPECT_EQ(t.tool(kGrasper).holds, 0);
  EXPECT_EQ(t.tool(kGrasper).aperture, 0);
  EXPECT_EQ(length(t.pull(kGrasper)), 0);
}

TEST(Grasp, OpeningLetsGo) {
  Grip g;
  g.lift({0, 0, 0.006});
  EXPECT_GT(length(g.pull(kGrasper)), 0.05);
  g.close_slowly(kGrasper, 0, 200);
  EXPECT_EQ(g.tool(kGrasper).holds, 0);
  EXPECT_EQ(g.count(sim::Event::released), 1);
  EXPECT_EQ(g.count(sim::Event::slipped), 0);
  EXPECT_EQ(length(g.pull(kGrasper)), 0);
}

TEST(Grasp, JawsThatTheTissueKeepsWideOpenLetGoAllTheSame) {
  scene::Description d = small::description();
  for (scene::Instrument& i : d.instruments)
    if (i.name == "grasper") i.opening = 0.190;  // hardly wider than the tube
  const sim::Model model = scene::compile(d);
  Grip g(model);
  ASSERT_GT(g.tool(kGrasper).holds, 0);
  ASSERT_GT(g.tool(kGrasper).aperture, 0.95);
  g.close_slowly(kGrasper, 0, 200);
  EXPECT_EQ(g.tool(kGrasper).holds, 0);
  EXPECT_EQ(g.count(sim::Event::slipped), 0);
}

TEST(Grasp, AGripMovesWithTheInstrument) {
  Grip g;
  for (Vec3d by : {Vec3d{0, 0, 0.008}, Vec3d{0.003, 0.004, 0}, Vec3d{-0.003, 0.002, 0.002}}) {
    g.lift(by);
    const ToolState& tool = g.tool(kGrasper);
    for (int i = 0; i < tool.holds; ++i) {
      const Hold& h = tool.hold[i];
      const Vec3d place = from_jaw(g.work.shapes[kGrasper], {h.local[0], h.local[1], h.local[2]});
      const double force = length(Vec3d{h.force[0], h.force[1], h.force[2]});
      EXPECT_LT(length(held_point(g.bodies(), h.at) - place), 1.1 * force / kHoldStiffness + 2e-5);
    }
  }
}

TEST(Grasp, ThePullIsWhatTheFoundationTheOrganAndTheWeightDo) {
  // At rest the forces on the tube add up to nothing: what the jaws feel is the stretch of its foundation and of the
  // fold below it, its weight, and the organ it grows out of.
  Grip g;
  for (double rise : {0.004, 0.004, 0.004}) {
    g.lift({0, 0, rise}, 0.02);
    g.steps(2000);
    const tissue::StrandModel& m = g.model.strand_bodies[kTube].model;
    const tissue::StrandState& s = g.state.strands[kTube];
    Vec3d on_tube{0, 0, 0};
    for (int i = 0; i < m.nodes; ++i) {
      const Vec3d u = s.x[size_t(i)] - m.foundation_point[size_t(i)];
      on_tube += m.mass[size_t(i)] * m.gravity;
      on_tube -= m.foundation[size_t(i)] * (1 + m.stiffening * dot(u, u)) * u;
    }
    on_tube -= g.work.strands[kTube].end_reactions[0].force;
    for (size_t h = 0; h < g.model.membranes[0].holds.size(); ++h) {
      const Attachment& hold = g.model.membranes[0].holds[h];
      if (hold.point.body.is(BodyKind::strand)) on_tube += g.work.membranes[0].pulls[h].force - hold.drawn_pull;
    }
    const Vec3d pull = g.pull(kGrasper);  // of the tissue on the jaws
    EXPECT_GT(length(pull), 0.05);
    EXPECT_LT(length(pull - on_tube), 0.02 * length(pull)) << "pull " << pull.z << " N, the rest " << on_tube.z << " N";
  }
}

TEST(Grasp, OfMoreTissueThanAGripCanHoldItHoldsSomeOfAll) {
  // A tube of 24 elements along jaws of 55 mm: 22 of them lie between the jaws, a grip holds 12 points.
  ToolModel m;
  m.kind = ToolKind::grasper;
  m.port = {0.03, 0, 0.10};
  m.jaw_length = 0.055;
  m.jaw_width = 0.003;
  m.opening = 0.4;
  kinematics::FulcrumPose pose = kinematics::inverse(m.port, {0.03, 0, -0.055}, 0);
  pose.roll = kinematics::roll_towards(pose, {1, 0, 0});
  const test::StraightTube tube(0.0016, {0.03, 0, 0}, {0, 0, -1});
  test::FewBodies few;
  few.models.strand_bodies.push_back(tube.body);
  few.states.strands.push_back(tube.state);
  ToolState tool;
  for (int i = 0; i <= 100 && tool.holds == 0; ++i) {
    tool.handle = 0.01 * i;
    update_grip(m, shape_of(m, pose, tool.aperture), few.all(), tool);
  }
  ASSERT_GT(tool.holds, 6);
  double low = 1, high = 0;
  for (int i = 0; i < tool.holds; ++i) {
    low = std::min(low, double(tool.hold[i].local[2]));
    high = std::max(high, double(tool.hold[i].local[2]));
  }
  EXPECT_LT(low, 0.006) << "near the hinge";
  EXPECT_GT(high, 0.048) << "near the tips";
}

TEST(Grasp, ForcesOnTissueAndJawsAreOpposite) {
  Grip g;
  g.lift({0, 0, 0.008});
  Vec3d on_tissue{0, 0, 0};
  const StrandLoads& loads = g.work.strands[kTube].loads;
  for (size_t i = 0; i < loads.list.size(); ++i)
    if (loads.tag[i].owner == Owner::tool_hold && loads.tag[i].index == kGrasper) on_tissue += loads.reaction[i];
  EXPECT_LT(length(on_tissue + g.pull(kGrasper)), 1e-6 * length(on_tissue));
}

TEST(Grasp, AWeakGripSlipsAndLetsGo) {
  // 1.5 N of pinch and a friction of 0.2 bear 0.3 N; 15 mm up the fold pulls with more.
  const sim::Model m = with_grasper(1.5, 0.2);
  Grip g(m, 1.0);
  ASSERT_GT(g.tool(kGrasper).holds, 0);
  const double bears = m.placed(kGrasper).friction * g.tool(kGrasper).pinch;
  EXPECT_NEAR(bears, 0.3, 0.05);
  double most = 0;
  for (int i = 0; i < 3000 && g.tool(kGrasper).slipped == 0; ++i) {
    g.tip.z += 0.00002;
    g.point(kGrasper, g.tip);
    g.step();
    most = std::max(most, length(g.pull(kGrasper)));
  }
  EXPECT_EQ(g.tool(kGrasper).slipped, 1);
  EXPECT_EQ(g.tool(kGrasper).holds, 0);
  EXPECT_EQ(g.count(sim::Event::slipped), 1);
  EXPECT_EQ(length(g.pull(kGrasper)), 0);
  EXPECT_LT(most, 1.5 * bears) << "[N] it never pulled much harder than friction bears";
  EXPECT_GT(most, 0.8 * bears);
}

TEST(Grasp, TissueThatSlidesOutBetweenStillJawsHasSlipped) {
  // Closed until they just touch: drawn up, the tube slides towards the ends, where the jaws stand farther apart.
  small::Table t(small::model());
  Vec3d tip = tip_around(0.055);
  t.carry(kGrasper, {0.055, 0, 0.04}, tip, 0.2);
  for (int i = 0; i < 2000 && t.tool(kGrasper).pinch < 0.1; ++i) {
    t.input.tools[kGrasper].handle += 0.0005f;
    t.step();
  }
  ASSERT_GT(t.tool(kGrasper).holds, 0);
  for (int i = 0; i < 3000 && t.tool(kGrasper).holds > 0; ++i) {
    tip.z += 0.00002;
    t.point(kGrasper, tip);
    t.step();
  }
  EXPECT_EQ(t.tool(kGrasper).holds, 0);
  EXPECT_EQ(t.count(sim::Event::slipped), 1);
  EXPECT_EQ(t.count(sim::Event::released), 0);
}

TEST(Grasp, LettingGoUnderTensionIsNoSlip) {
  Grip g;
  g.lift({0, 0, 0.015}, 0.05);
  EXPECT_GT(length(g.pull(kGrasper)), 0.1);
  g.close_slowly(kGrasper, 0, 4000);
  EXPECT_EQ(g.tool(kGrasper).holds, 0);
  EXPECT_EQ(g.count(sim::Event::released), 1);
  EXPECT_EQ(g.count(sim::Event::slipped), 0);
}

TEST(Grasp, AFirmGripDoesNotSlip) {
  Grip g;
  g.lift({0, 0, 0.015}, 0.05);
  EXPECT_GT(g.tool(kGrasper).holds, 0);
  EXPECT_EQ(g.tool(kGrasper).slipped, 0);
}

TEST(Grasp, AfterASlipTheTissueComesBack) {
  const sim::Model m = with_grasper(1.5, 0.2);
  Grip g(m, 1.0);
  for (int i = 0; i < 3000 && g.tool(kGrasper).slipped == 0; ++i) {
    g.tip.z += 0.00002;
    g.point(kGrasper, g.tip);
    g.step();
  }
  ASSERT_EQ(g.tool(kGrasper).slipped, 1);
  g.carry(kGrasper, g.tip, {0.055, 0, 0.04}, 0.1);
  g.steps(3000);
  const tissue::StrandModel& tube = m.strand_bodies[kTube].model;
  double worst = 0;
  for (int i = 0; i < tube.nodes; ++i)
    worst = std::max(worst, length(g.state.strands[kTube].x[size_t(i)] - tube.rest[size_t(i)]));
  EXPECT_LT(worst, 1e-4);
}

TEST(Grasp, AFoldOfAnOrganIsHeldAndFollows) {
  // Into the organ's top, from the side.
  small::Table t(small::model());
  const Vec3d above{-0.018, 0, 0.030}, in{-0.018, 0, 0.005};
  t.carry(kGrasper, {0.055, 0, 0.04}, above, 0.2);
  t.carry(kGrasper, above, in, 0.1);
  t.close_slowly(kGrasper, 1, 500);
  const ToolState& tool = t.tool(kGrasper);
  ASSERT_GT(tool.holds, 0);
  ASSERT_TRUE(tool.hold[0].at.body.is(BodyKind::organ));
  const int solid = int(tool.hold[0].at.body.index()), vertex = vertex_of(sim::bodies_of(t.model, t.state), tool.hold[0].at);
  const Vec3d before = t.work.surfaces[size_t(solid)].position(vertex);
  t.carry(kGrasper, in, in + Vec3d{0, 0, 0.010}, 0.05);
  t.steps(500);
  ASSERT_GT(tool.holds, 0);
  EXPECT_GT(t.work.surfaces[size_t(solid)].position(vertex).z, before.z + 0.005);
  EXPECT_LT(t.pull(kGrasper).z, -0.05) << "it pulls the jaws down";
  EXPECT_TRUE((t.flags & (tissue::StepReport::kNonFinite | tissue::StepReport::kIndefinite)) == 0);
}

}  // namespace
