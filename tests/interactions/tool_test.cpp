// Instruments: shape, jaws, and how fast hands are.
#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/interactions/instrument/tool.hpp>
#include <trocar/numerics/portable.hpp>

using namespace trocar;
using namespace trocar::interactions;

namespace {

ToolModel hinged() {
  ToolModel m;
  m.kind = ToolKind::grasper;
  m.port = {0.1, -0.07, -0.01};
  m.opening = 1.0;
  return m;
}

ToolModel parallel() {
  ToolModel m = hinged();
  m.kind = ToolKind::clip_applier;
  m.opening = 0;
  m.parallel_gap = 0.006;
  return m;
}

ToolModel hook() {
  ToolModel m = hinged();
  m.kind = ToolKind::hook;
  m.jaw_length = 0.012;
  m.jaw_thickness = 0.0012;
  m.opening = 0;
  m.foot = 0.0026;
  return m;
}

const kinematics::FulcrumPose kPose{0.3, -0.4, 0.7, 0.15};

TEST(ToolShape, ShaftAndJawsLieOnTheLineThroughThePort) {
  const ToolModel m = hinged();
  const ToolShape s = shape_of(m, kPose, 0);
  EXPECT_NEAR(length(s.frame.tip - m.port), kPose.depth, 1e-12);
  for (Vec3d p : {s.part[kShaft].a, s.part[kShaft].b, s.pivot})
    EXPECT_LT(length(cross(p - m.port, s.frame.axis())), 1e-12);
  EXPECT_NEAR(length(s.frame.tip - s.pivot), m.jaw_length, 1e-12);
  EXPECT_EQ(s.part[kShaft].radius, m.shaft_radius);
}

TEST(ToolKind, MessagesNameAllThatCanDoSomething) {
  EXPECT_EQ(kinds_that(&Abilities::set_clips), "clip_applier");
  EXPECT_EQ(kinds_that(&Abilities::coagulate), "hook or bipolar");
  EXPECT_TRUE(about(ToolKind::dissector).can.blunt());
  EXPECT_FALSE(about(ToolKind::scissors).can.blunt());
}

TEST(ToolShape, HingedJawsOpenByTheirAngleSymmetrically) {
  const ToolModel m = hinged();
  for (double aperture : {0.0, 0.3, 1.0}) {
    const ToolShape s = shape_of(m, kPose, aperture);
    Vec3d jaw[2];
    for (int j = 0; j < 2; ++j) {
      jaw[j] = s.part[kJawA + j].b - s.part[kJawA + j].a;
      EXPECT_NEAR(length(jaw[j]), m.jaw_length, 1e-12);
      EXPECT_NEAR(dot(jaw[j], s.frame.normal()), 0, 1e-12) << "in the jaw plane";
    }
    EXPECT_NEAR(portable::acos(std::min(1.0, dot(jaw[0], jaw[1]) / (m.jaw_length * m.jaw_length))), aperture, 1e-7);
    EXPECT_NEAR(dot(jaw[0] + jaw[1], s.frame.opening()), 0, 1e-12);
    EXPECT_GT(dot(s.part[kJawA].a - s.part[kJawB].a, s.frame.opening()), 0) << "jaw A is on the opening's side";
  }
}

TEST(ToolShape, ParallelJawsStayParallelAndLeaveTheirGap) {
  const ToolModel m = parallel();
  for (double aperture : {0.0, 0.5, 1.0}) {
    const ToolShape s = shape_of(m, kPose, aperture);
    const Vec3d a = s.part[kJawA].b - s.part[kJawA].a, b = s.part[kJawB].b - s.part[kJawB].a;
    EXPECT_LT(length(cross(a, b)), 1e-12);
    const double between =
        dot(s.part[kJawA].a - s.part[kJawB].a, s.frame.opening()) - s.part[kJawA].radius - s.part[kJawB].radius;
    EXPECT_NEAR(between, aperture * m.parallel_gap, 1e-12);
    EXPECT_NEAR(2 * s.half_opening(0.01), aperture * m.parallel_gap, 1e-12);
  }
}

TEST(ToolShape, AHooksFootGoesFromItsWiresEndToWhereJawsWouldOpenAndNothingReachesBeyondTheTip) {
  const ToolModel m = hook();
  for (double aperture : {0.0, 1.0}) {
    const ToolShape s = shape_of(m, kPose, aperture);
    const Capsule &wire = s.part[kJawA], &foot = s.part[kJawB];
    EXPECT_LT(length(wire.a - s.pivot), 1e-12);
    EXPECT_EQ(length(wire.b - foot.a), 0) << "one bent wire";
    EXPECT_NEAR(to_jaw(s, wire.b).z + wire.radius, m.jaw_length, 1e-12);
    EXPECT_LT(length(to_jaw(s, foot.b) - Vec3d{m.foot - foot.radius, 0, m.jaw_length - foot.radius}), 1e-12);
    EXPECT_EQ(s.half_opening(0.01), 0) << "it does not open";
  }
}

TEST(ToolShape, JawFrameAndBackIsIdentity) {
  core::Random random(1);
  const ToolShape s = shape_of(hinged(), kPose, 0.5);
  for (int i = 0; i < 100; ++i) {
    const Vec3d p{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    EXPECT_LT(length(from_jaw(s, to_jaw(s, p)) - p), 1e-12);
  }
  EXPECT_LT(length(to_jaw(s, s.frame.tip) - Vec3d{0, 0, hinged().jaw_length}), 1e-12);
}

TEST(ToolShape, AtTheApertureOfATissueTheGapIsItsThickness) {
  for (const ToolModel& m : {hinged(), parallel()})
    for (double thickness : {0.001, 0.0022, 0.005})
      for (double along : {0.006, 0.012, 0.020}) {
        const double aperture = aperture_at(m, thickness, along);
        ASSERT_LT(aperture, 1);
        EXPECT_NEAR(2 * shape_of(m, kPose, aperture).half_opening(along), thickness, 1e-7);
      }
}

TEST(ToolShape, ApertureNeverExceedsOpen) {
  EXPECT_EQ(aperture_at(hinged(), 0.5, 0.01), 1);
  EXPECT_EQ(aperture_at(parallel(), 0.5, 0.01), 1);
}

TEST(Hands, ReachTheirGoalExactly) {
  const ToolModel m = hinged();
  ToolState s;
  for (int t = 0; t < 2000; ++t) follow(m, {kPose, 0.8}, 1e-3, s);
  EXPECT_EQ(s.yaw, kPose.yaw);
  EXPECT_EQ(s.pitch, kPose.pitch);
  EXPECT_EQ(s.roll, kPose.roll);
  EXPECT_EQ(s.depth, kPose.depth);
  EXPECT_EQ(s.handle, 0.8);
}

Vec3d tip(const ToolModel& m, const ToolState& s) { return kinematics::forward(m.port, s.pose()).tip; }

TEST(Hands, AreAsFastAsHands) {
  // Across at 290 mm, along, and both: the tip gets its 0.6 m/s.
  const ToolModel m = hinged();
  for (const kinematics::FulcrumPose& goal :
       {kinematics::FulcrumPose{1, 0, 0, 0.2}, kinematics::FulcrumPose{0, 0, 0, 0.28},
        kinematics::FulcrumPose{1, 1, 0, 0.28}}) {
    ToolState s;
    s.depth = 0.2;
    const Vec3d from = tip(m, s);
    follow(m, {goal, 0}, 1e-3, s);
    EXPECT_NEAR(length(tip(m, s) - from), 0.0006, 2e-6);
  }
}

TEST(Hands, AreNoFasterThanHands) {
  // Whatever is asked for: at most 0.6 m/s at the tip, 4 rad/s of each angle, 8 rad/s of roll, 8 handles a second.
  core::Random random(2);
  const ToolModel m = hinged();
  ToolState s;
  s.depth = 0.1;
  for (int t = 0; t < 5000; ++t) {
    const ToolState before = s;
    const kinematics::FulcrumPose goal{random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-20, 20),
                                       random.uniform(-1, 1)};
    follow(m, {goal, random.uniform(-3, 3)}, 1e-3, s);
    EXPECT_LE(std::fabs(s.yaw - before.yaw), 0.004 + 1e-15);
    EXPECT_LE(std::fabs(s.pitch - before.pitch), 0.004 + 1e-15);
    EXPECT_LE(std::fabs(s.roll - before.roll), 0.008 + 1e-15);
    EXPECT_LE(length(tip(m, s) - tip(m, before)), 0.0006 * (1 + 1e-3));
    EXPECT_LE(std::fabs(s.handle - before.handle), 0.008 + 1e-15);
  }
}

TEST(Hands, StayWithinTheTrocarsLimits) {
  core::Random random(3);
  const ToolModel m = hinged();
  ToolState s;
  s.depth = 0.1;
  for (int t = 0; t < 20000; ++t) {
    const double far = t % 1000 < 500 ? 9 : -9;
    follow(m, {{far, -far, far, far}, far}, 1e-3, s);
    ASSERT_LE(std::fabs(s.yaw), m.limits.angle);
    ASSERT_LE(std::fabs(s.pitch), m.limits.angle);
    ASSERT_LE(std::fabs(s.roll), m.limits.roll);
    ASSERT_GE(s.depth, m.limits.depth_min);
    ASSERT_LE(s.depth, m.limits.depth_max);
    ASSERT_GE(s.handle, 0);
    ASSERT_LE(s.handle, 1);
  }
}

}  // namespace
