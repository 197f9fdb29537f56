// Wrists and flexible sections beyond the trocar: where they are, and how they are led.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/kinematics/articulation.hpp>
#include <trocar/kinematics/chains/frame.hpp>

using namespace trocar;
using namespace trocar::kinematics;

namespace {

constexpr Vec3d kPort{0.07, 0.035, 0.01};
constexpr double kJaw = 0.014;

/// Four vertebrae that share two joints, and a wrist: eight coordinates with the shaft's for the six of a tip.
Articulation flexible() {
  Articulation a;
  a.joints = 4;
  for (int v = 0; v < 4; ++v)
    for (int across = 0; across < 2; ++across)
      a.hinge[a.hinges++] = {v > 0 && across == 0 ? 0.005 : 0.0, 0.25, across, across};
  a.hinge[a.hinges++] = {0.005, 1, 2, 0};
  a.hinge[a.hinges++] = {0.009, 1, 3, 1};
  for (int j = 0; j < 4; ++j) a.low[j] = j < 2 ? -1.57 : -1.39, a.high[j] = -a.low[j];
  return a;
}

FulcrumPose any_pose(core::Random& r) {
  return {r.uniform(-0.8, 0.8), r.uniform(-0.8, 0.8), r.uniform(-3, 3), r.uniform(0.09, 0.18)};
}

double turn_off(const TipFrame& a, const Mat3d& b) { return length(turn_between(a.rotation, b)); }

TEST(Articulation, StraightItIsTheRigidInstrument) {
  core::Random random(1);
  for (const Articulation& a : {wrist(0.004, 0.008, 1.4, 1.4), flexible()})
    for (int i = 0; i < 100; ++i) {
      const FulcrumPose pose = any_pose(random);
      const TipFrame bent = forward(a, kPort, pose, {}, kJaw), rigid = forward(kPort, pose);
      EXPECT_LT(length(bent.tip - rigid.tip), 1e-15);
      EXPECT_LT(turn_off(bent, rigid.rotation), 1e-12);
    }
}

TEST(Articulation, AWristTurnsTheJawsAboutItsHingesAndKeepsItsLengths) {
  const Articulation a = wrist(0.004, 0.008, 1.4, 1.4);
  const FulcrumPose pose{0, 0, 0, 0.12};
  const Chain c = chain(a, {0, 0, 0}, pose, {{0.5, 0, 0, 0}}, kJaw);
  ASSERT_EQ(c.links, 2);
  EXPECT_NEAR(c.shaft.tip.z, -(0.12 - 0.004 - 0.008 - kJaw), 1e-15);
  EXPECT_NEAR(c.tip.axis().y, std::sin(0.5), 1e-12) << "pitch goes to the jaw plane's normal";
  const TipFrame yawed = forward(a, {0, 0, 0}, pose, {{0, 0.5, 0, 0}}, kJaw);
  EXPECT_NEAR(yawed.axis().x, -std::sin(0.5), 1e-12) << "yaw goes along the opening";
  EXPECT_NEAR(length(c.bend[1] - c.bend[0]), 0.004, 1e-15);
  EXPECT_NEAR(length(c.bend[2] - c.bend[1]), 0.008, 1e-15);
  EXPECT_NEAR(length(c.tip.tip - c.bend[2]), kJaw, 1e-15);
}

TEST(Articulation, ReachingComesToAnyFrameThatTheChainCanStandIn) {  // [Wampler 1986]
  core::Random random(2);
  for (const Articulation& a : {wrist(0.004, 0.008, 1.4, 1.4), flexible()}) {
    const FulcrumLimits limits;
    int reached = 0;
    constexpr int kPoses = 500;
    for (int i = 0; i < kPoses; ++i) {
      Joints joints;
      for (int j = 0; j < a.joints; ++j) joints.angle[j] = random.uniform(0.6 * a.low[j], 0.6 * a.high[j]);
      FulcrumPose pose = any_pose(random);
      pose.roll = random.uniform(-1, 1);
      const TipFrame goal = forward(a, kPort, pose, joints, kJaw);
      const Arm arm = reach(a, limits, kPort, kJaw, {goal.tip, goal.rotation}, {{0, 0, 0, 0.12}, {}}, 200);
      const TipFrame there = forward(a, kPort, arm.pose, arm.joints, kJaw);
      reached += length(there.tip - goal.tip) < 1e-4 && turn_off(there, goal.rotation) < 2e-3;
    }
    EXPECT_GT(reached, kPoses * 95 / 100) << a.joints << " joints";
  }
}

TEST(Articulation, FourRoundsATickFollowAHandAndHoldThePort) {
  const Articulation a = flexible();
  const FulcrumLimits limits;
  Arm arm{{0.2, -0.3, 0, 0.13}, {}};
  double worst = 0, worst_turn = 0;
  for (int tick = 0; tick < 3000; ++tick) {
    const double t = 1e-3 * tick;
    const FulcrumPose led_pose{0.2 + 0.1 * std::sin(t), -0.3 + 0.1 * std::sin(1.3 * t), 0.4 * std::sin(t), 0.13};
    const TipFrame goal = led(kPort, led_pose, 0.9 * std::sin(2 * t), 0.7 * std::sin(1.5 * t));
    arm = reach(a, limits, kPort, kJaw, {goal.tip, goal.rotation}, arm, 4);
    const Chain c = chain(a, kPort, arm.pose, arm.joints, kJaw);
    const Vec3d shaft = c.shaft.tip - kPort;
    EXPECT_LT(length(cross(shaft, c.shaft.axis())), 1e-15 + 1e-12) << "the shaft goes through its port";
    for (int j = 0; j < a.joints; ++j) {
      EXPECT_GE(arm.joints.angle[j], a.low[j]);
      EXPECT_LE(arm.joints.angle[j], a.high[j]);
    }
    worst = std::max(worst, length(c.tip.tip - goal.tip));
    worst_turn = std::max(worst_turn, turn_off(c.tip, goal.rotation));
  }
  EXPECT_LT(worst, 2e-4);
  EXPECT_LT(worst_turn, 1e-2);
}

TEST(Articulation, WhatIsLeftOverStraightensTheChain) {  // [Liegeois 1977]
  const Articulation a = flexible();
  const FulcrumPose pose{0.1, 0.2, 0, 0.13};
  const TipFrame goal = led(kPort, pose, 0.8, 0.2);
  // Bent one way in the section and back in the wrist: more than the goal takes.
  Arm arm = reach(a, {}, kPort, kJaw, {goal.tip, goal.rotation}, {pose, {{1.2, 0.3, -0.6, 0}}}, 20);
  const auto bent = [](const Arm& at) {
    double sum = 0;
    for (const double angle : at.joints.angle) sum += angle * angle;
    return sum;
  };
  const double before = bent(arm);
  arm = reach(a, {}, kPort, kJaw, {goal.tip, goal.rotation}, arm, 200);
  const TipFrame there = forward(a, kPort, arm.pose, arm.joints, kJaw);
  EXPECT_LT(bent(arm), before);
  EXPECT_LT(length(there.tip - goal.tip), 2e-4);
}

TEST(Articulation, AGoalWithoutATurnLeavesTheJawsFreeAboutTheirAxis) {
  const Articulation a = wrist(0, 0.01, 1.4, 1.4);
  core::Random random(4);
  for (int i = 0; i < 200; ++i) {
    const Vec3d out = normalised(Vec3d{random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6), 1});
    const Vec3d x = any_perpendicular(out);
    Goal goal{{0.02 + random.uniform(-0.02, 0.02), 0.08, -0.09}, Mat3d::from_columns(x, cross(out, x), out), false};
    const Arm arm = reach(a, {}, kPort, kJaw, goal, {{0.2, -0.3, 0, 0.13}, {}}, 100);
    const TipFrame there = forward(a, kPort, arm.pose, arm.joints, kJaw);
    EXPECT_LT(length(there.tip - goal.tip), 1e-4);
    EXPECT_GT(dot(there.axis(), -out), std::cos(0.01));
  }
}

TEST(Articulation, BrokenGoalsLeaveFiniteNumbersWithinLimits) {
  const Articulation a = flexible();
  const FulcrumLimits limits;
  Arm arm{{0, 0, 0, 0.1}, {}};
  for (const Vec3d& tip : {Vec3d{10, 0, 0}, Vec3d{0, 0, 0}, kPort, Vec3d{-1e6, 1e6, 3}}) {
    arm = reach(a, limits, kPort, kJaw, {tip, Mat3d::identity()}, arm, 50);
    for (const double v : {arm.pose.yaw, arm.pose.pitch, arm.pose.roll, arm.pose.depth}) EXPECT_TRUE(std::isfinite(v));
    EXPECT_LE(arm.pose.depth, limits.depth_max);
    for (const double v : arm.joints.angle) EXPECT_TRUE(std::isfinite(v));
  }
}

}  // namespace
