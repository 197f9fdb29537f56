#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/kinematics/fulcrum.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::kinematics {
namespace {

TEST(Fulcrum, InverseThenForwardIsIdentity) {
  core::Random random(1);
  const Vec3d port{0.105, -0.075, -0.015};
  double worst = 0;
  for (int i = 0; i < 10000; ++i) {
    const Vec3d tip{random.uniform(-0.2, 0.2), random.uniform(-0.3, 0.1), random.uniform(-0.25, -0.03)};
    const double roll = random.uniform(-3, 3);
    worst = std::max(worst, length(forward(port, inverse(port, tip, roll)).tip - tip));
  }
  EXPECT_LT(worst, 1e-9);
}

TEST(Fulcrum, ThePortPointStaysOnTheShaft) {
  core::Random random(2);
  const Vec3d port{-0.1, -0.07, -0.01};
  for (int i = 0; i < 10000; ++i) {
    const FulcrumPose pose{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3, 3),
                           random.uniform(0.02, 0.25)};
    const TipFrame f = forward(port, pose);
    EXPECT_LT(length(cross(port - f.tip, f.axis())), 1e-9);
  }
}

TEST(Fulcrum, LateralGainIsMirroredAndGrowsWithDepth) {
  // A hand 0.1 m outside the port that goes one way moves the tip the other way by -d/(L-d).
  const double d = 0.15;
  const Vec3d before = forward({}, {0, 0, 0, d}).tip, after = forward({}, {1e-4, 0, 0, d}).tip;
  const double handle = 0.310 - d;
  const Vec3d hand_before = -handle * forward({}, {0, 0, 0, d}).axis();
  const Vec3d hand_after = -handle * forward({}, {1e-4, 0, 0, d}).axis();
  EXPECT_NEAR((after - before).x / (hand_after - hand_before).x, -d / handle, 1e-6);
}

TEST(Fulcrum, RollTurnsTheJawPlaneNormalTowardsADirection) {
  const FulcrumPose pose = inverse({0, -0.13, -0.005}, {0.03, -0.15, -0.09}, 0);
  const Vec3d along = normalised(Vec3d{1, 0, 0.35});
  FulcrumPose rolled = pose;
  rolled.roll = roll_towards(pose, along);
  const TipFrame f = forward({}, rolled);
  const Vec3d in_plane = normalised(along - dot(along, f.axis()) * f.axis());
  EXPECT_NEAR(dot(f.normal(), in_plane), 1.0, 1e-9);
}

TEST(Scope, LightPostTurnsTheViewAndHeadKeepsTheHorizon) {
  const FulcrumPose pose = inverse({}, {0, -0.06, -0.05}, 0);
  const double angle = 30 * portable::pi / 180;
  const Vec3d axis = forward({}, pose).axis();
  for (double post : {0.0, 1.0, 2.0, 3.0}) {
    const ScopeFrame f = scope_frame({}, pose, angle, post);
    EXPECT_NEAR(portable::acos(dot(f.forward, axis)), angle, 1e-9);
    EXPECT_NEAR(f.right.z, 0, 1e-9) << "the horizon stays level";
    EXPECT_NEAR(dot(f.up, f.forward), 0, 1e-12);
  }
}

TEST(ScopeFrame, IsARotationAlsoWhereAnObliqueLensLooksStraightDown) {
  const Vec3d port{0, 0, 0};
  for (const double angle : {0.0, portable::pi / 6, portable::pi / 4})
    for (double post = -3; post < 3; post += 0.25)
      for (const Vec3d down : {Vec3d{0, 0, -1}, Vec3d{0.02, 0, -1}, Vec3d{0, -0.57735, -1}, Vec3d{0.57735, 0, -1}}) {
        FulcrumPose pose = inverse(port, 0.05 * normalised(down), 0.3);
        const ScopeFrame f = scope_frame(port, pose, angle, post);
        for (const Vec3d& axis : {f.right, f.up, f.forward}) EXPECT_NEAR(length(axis), 1, 1e-9);
        EXPECT_NEAR(dot(f.up, f.forward), 0, 1e-9);
        EXPECT_NEAR(dot(f.right, f.up), 0, 1e-9);
      }
}

}  // namespace
}  // namespace trocar::kinematics
