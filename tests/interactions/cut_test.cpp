// Scissors on strands: what lies between the blades is cut as far as they reach over it.
#include <array>

#include <gtest/gtest.h>

#include <trocar/interactions/verbs/cut.hpp>

#include "../sim/small_scene.hpp"
#include "few_bodies.hpp"
#include "straight_tube.hpp"

using namespace trocar;
using namespace trocar::interactions;

namespace {

using test::StraightTube;

ToolModel scissors() {
  ToolModel m;
  m.kind = ToolKind::scissors;
  m.port = {0.030, 0, 0.10};
  m.jaw_length = 0.015;
  m.jaw_width = 0.0025;
  m.jaw_thickness = 0.0012;
  m.opening = 0.8;
  return m;
}

/// Vertical scissors over x = 30 mm of one or two tubes; blades of 15 mm, the tube `inside` from the hinge.
struct Cutting {
  ToolModel model = scissors();
  test::FewBodies few;
  std::vector<StrandBody>& bodies = few.models.strand_bodies;
  std::vector<tissue::StrandState>& states = few.states.strands;
  ToolState tool;
  std::array<Cut, kMaxCuts> cuts{};
  std::int32_t count = 0;
  kinematics::FulcrumPose pose;

  explicit Cutting(double inside) {
    pose = kinematics::inverse(model.port, {0.030, 0, inside - model.jaw_length}, 0);
    pose.roll = kinematics::roll_towards(pose, {1, 0, 0});
    add(StraightTube());
  }
  void add(const StraightTube& tube) {
    bodies.push_back(tube.body);
    states.push_back(tube.state);
  }
  int at(double aperture) {
    tool.aperture = aperture;
    return update_scissors(model, shape_of(model, pose, aperture), 1, few.all(), states, 1, 77, tool, {cuts, count});
  }
  int snip() {
    at(1.0);
    return at(0.6) + at(0.3) + at(0.19) + at(0.1) + at(0);
  }
  int severed(size_t strand = 0) const {
    return int(std::count(states[strand].alive.begin(), states[strand].alive.end(), 0));
  }
};

TEST(Cut, ThroughWhenTheWholeTubeLiesBetweenTheBlades) {
  Cutting c(0.010);
  EXPECT_EQ(c.snip(), 1);
  ASSERT_EQ(c.count, 1);
  EXPECT_EQ(c.cuts[0].strand, 0);
  EXPECT_EQ(c.cuts[0].tool, 1);
  EXPECT_EQ(c.cuts[0].tick, 77u);
  EXPECT_NEAR(c.cuts[0].s, 0.030, 1e-9);
  EXPECT_NEAR(c.cuts[0].fraction, 1, 1e-12);
  EXPECT_EQ(c.severed(), 1);
  EXPECT_EQ(c.states[0].alive[size_t(place_at(c.bodies[0], 0.0300001).element)] +
                c.states[0].alive[size_t(place_at(c.bodies[0], 0.0299999).element)],
            1)
      << "one of the two elements that meet at 30 mm";
}

TEST(Cut, BeyondIsHowFarTheBladesReachPastTheTube) {
  // 15 mm blades, the tube's centre 10 mm from the hinge, its radius 1.6 mm: 3.4 mm into what lies behind.
  Cutting c(0.010);
  c.snip();
  EXPECT_NEAR(c.cuts[0].beyond, 0.0034, 1e-9);
  Cutting deep(0.004);
  deep.snip();
  EXPECT_NEAR(deep.cuts[0].beyond, 0.0094, 1e-9);
}

TEST(Cut, BladesAreAskedBeforehandWhatTheyWillCut) {
  for (const double inside : {-0.005, 0.0005, 0.004, 0.010, 0.0145, 0.016, 0.018}) {
    Cutting c(inside);
    const BetweenBlades asked = between_blades(c.model, shape_of(c.model, c.pose, 0.1), c.bodies[0], c.states[0]);
    EXPECT_EQ(c.snip(), int(asked.element >= 0)) << inside;
    if (asked.element < 0) continue;
    EXPECT_EQ(c.cuts[0].fraction, asked.fraction) << inside;
    EXPECT_EQ(c.cuts[0].s, arc_at(c.bodies[0], {asked.element, asked.where.w})) << inside;
  }
  Cutting spared(0.010);
  spared.bodies[0].cuttable = false;
  EXPECT_EQ(between_blades(spared.model, shape_of(spared.model, spared.pose, 0.1), spared.bodies[0], spared.states[0])
                .element,
            -1);
}

TEST(Cut, HalfOutOfTheBladesItIsCutByHalfAndWeakenedByHalf) {
  Cutting c(0.015);  // the blades end at the tube's centre
  EXPECT_EQ(c.snip(), 1);
  EXPECT_NEAR(c.cuts[0].fraction, 0.5, 1e-9);
  EXPECT_EQ(c.cuts[0].beyond, 0);
  EXPECT_EQ(c.severed(), 0);
  double least = 1;
  for (double scale : c.states[0].scale) least = std::min(least, scale);
  EXPECT_NEAR(least, 0.5, 1e-9);
}

TEST(Cut, ASecondSnipAtTheSamePlaceWeakensFurther) {
  Cutting c(0.015);
  c.snip();
  c.snip();
  double least = 1;
  for (double scale : c.states[0].scale) least = std::min(least, scale);
  EXPECT_NEAR(least, 0.25, 1e-9);
  EXPECT_EQ(c.count, 2);
}

TEST(Cut, NothingBetweenTheBladesIsNoCut) {
  Cutting c(0.010);
  c.pose.depth -= 0.03;
  EXPECT_EQ(c.snip(), 0);
  EXPECT_EQ(c.count, 0);
  EXPECT_EQ(c.severed(), 0);
}

TEST(Cut, AStrandThatMustNotBeCutIsNotCut) {
  Cutting c(0.010);
  c.bodies[0].cuttable = false;
  EXPECT_EQ(c.snip(), 0);
  EXPECT_EQ(c.count, 0);
  EXPECT_EQ(c.severed(), 0);
}

TEST(Cut, TwoStrandsBetweenTheBladesAreBothCut) {
  Cutting c(0.007);
  c.add(StraightTube(0.001, {0, 0, -0.005}));  // 12 mm from the hinge
  EXPECT_EQ(c.snip(), 2);
  EXPECT_EQ(c.count, 2);
  EXPECT_EQ(c.severed(0), 1);
  EXPECT_EQ(c.severed(1), 1);
}

TEST(Cut, BladesMustOpenAgainForTheNextOne) {
  Cutting c(0.010);
  EXPECT_EQ(c.snip(), 1);
  c.states[0] = tissue::rest_state(c.bodies[0].model);
  EXPECT_EQ(c.at(0.4) + c.at(0.1), 0);
  EXPECT_EQ(c.snip(), 1);
}

TEST(Cut, MoreCutsThanTheBufferHoldsAreNotWrittenPastItsEnd) {
  Cutting c(0.015);
  for (int i = 0; i < kMaxCuts + 5; ++i) c.snip();
  EXPECT_EQ(c.count, kMaxCuts);
}

TEST(Cut, AcrossItNothingPulls) {
  // The tube is clipped, cut and held beyond the cut; drawing the held piece away moves nothing of the stump.
  small::Table t(small::bare());
  small::Hands hands(t.model);
  while (!hands.done()) {
    t.input = hands.next(t.state);
    t.step();
  }
  ASSERT_EQ(t.state.cut_count, 2) << "the tube, then the bar";
  ASSERT_GT(t.tool(small::kGrasper).holds, 0);
  ASSERT_EQ(t.tool(small::kGrasper).hold[0].at.body, BodyId::strand(small::kTube));
  t.steps(2000);
  const int cut = place_at(t.model.strand_bodies[small::kTube], t.state.cuts[0].s).element;
  const std::vector<Vec3d> before = t.state.strands[small::kTube].x;
  const Vec3d tip = t.work.shapes[small::kGrasper].frame.tip;
  t.carry(small::kGrasper, tip, tip + Vec3d{0.010, 0, 0.010}, 0.05);
  t.steps(1000);
  const std::vector<Vec3d>& after = t.state.strands[small::kTube].x;
  for (int n = 0; n <= cut; ++n) EXPECT_LT(length(after[size_t(n)] - before[size_t(n)]), 2e-6) << "node " << n;
  EXPECT_GT(length(after[size_t(cut) + 1] - before[size_t(cut) + 1]), 1e-3) << "the other piece went along";
}

}  // namespace
