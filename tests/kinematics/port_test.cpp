// Trocars that give: where the fulcrum goes, and where an instrument is whose handle is held.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/kinematics/port.hpp>

namespace trocar::kinematics {
namespace {

constexpr double kLength = 0.310;  // [m] of the shaft

PortModel port(double stiffness, double drift, std::uint64_t seed = 5) {
  return {stiffness, drift, seed, {{1, 0, 0}, {0, 1, 0}}};
}

/// Of a handle about a fulcrum at `shift`.
Vec3d handle(const FulcrumPose& pose, Vec3d shift, double outside) {
  return shift - outside * forward({}, pose).axis();
}

TEST(Port, WandersWithinItsDiscWithoutLeapsAndTheSameForTheSameSeed) {
  for (const std::uint64_t seed : {1u, 2u, 77u}) {
    const PortModel m = port(0, 0.003, seed);
    Vec3d last;
    double far = 0;
    for (int ms = 0; ms <= 600'000; ms += 10) {
      const Vec3d at = drift_of(m, 1e-3 * ms);
      far = std::max(far, length(at));
      EXPECT_EQ(at.z, 0);
      EXPECT_LT(length(at - last), 1e-2 * 0.0006) << "1.875 times the mean speed of a leg across the whole disc";
      last = at;
    }
    EXPECT_LE(far, 0.003 + 1e-12);
    EXPECT_GT(far, 0.002) << "in thirty legs it comes near its rim";
    EXPECT_EQ(drift_of(m, 43.21).x, drift_of(port(0, 0.003, seed), 43.21).x);
  }
  EXPECT_NE(drift_of(port(0, 0.003, 1), 30).x, drift_of(port(0, 0.003, 2), 30).x);
  EXPECT_EQ(length(drift_of(port(0, 0.003), 0)), 0) << "it begins in its place";
}

TEST(Port, WhereItGivesTheHandleStaysAndTheShaftGoesThroughIt) {
  const FulcrumPose pose{0.3, -0.4, 0.7, 0.12};
  const Vec3d shift{0.004, -0.002, 0.003};
  const double outside = kLength - pose.depth;
  const FulcrumPose now = about_shifted(pose, shift, outside);
  const double now_outside = kLength - now.depth;
  EXPECT_LT(length(handle(pose, {}, outside) - handle(now, shift, now_outside)), 1e-12);
  EXPECT_EQ(now.roll, pose.roll);
  const FulcrumPose back = about_shifted(now, -shift, now_outside);
  EXPECT_NEAR(back.yaw, pose.yaw, 1e-12);
  EXPECT_NEAR(back.pitch, pose.pitch, 1e-12);
  EXPECT_NEAR(back.depth, pose.depth, 1e-12);
}

TEST(Port, TheTipGoesFartherThanThePortByTheLeverInToOut) {
  for (const double depth : {0.05, 0.12, 0.2}) {
    const FulcrumPose pose{0.2, 0.1, 0, depth};
    const Vec3d axis = forward({}, pose).axis(), across = normalised(cross(axis, Vec3d{0, 1, 0}));
    const Vec3d shift = 1e-5 * across;
    const Vec3d way = shift + forward({}, about_shifted(pose, shift, kLength - depth)).tip - forward({}, pose).tip;
    EXPECT_NEAR(length(way) / length(shift), 1 + depth / (kLength - depth), 1e-3) << depth;
  }
}

TEST(Port, AForceThatStaysDisplacesItByForceOverStiffness) {
  const PortModel m = port(1000, 0);
  PortState s;
  for (int ms = 0; ms < 1000; ++ms) s = moved(m, s, {2, -1, 0}, {0, 0, 0, 0.1}, 0.21, 1e-3 * ms, 1e-3);
  EXPECT_NEAR(s.give.x, 0.002, 1e-6);
  EXPECT_NEAR(s.give.y, -0.001, 1e-6);
  for (int ms = 0; ms < 1000; ++ms) s = moved(m, s, {90, 0, 0}, {0, 0, 0, 0.1}, 0.21, 1, 1e-3);
  EXPECT_NEAR(s.give.x, kMostGive, 1e-6) << "it goes no farther";
  for (int ms = 0; ms < 2000; ++ms) s = moved(m, s, {}, {0, 0, 0, 0.1}, 0.21, 1, 1e-3);
  EXPECT_LT(length(s.shift), 1e-9) << "and comes back";
}

/// A hand presses an instrument 1 mm across into tissue that is a spring at the tip: what is left of the force.
double settled(double tissue, double stiffness, double depth, double& swing) {
  const PortModel m = port(stiffness, 0);
  const double outside = std::max(kLeastOutside, kLength - depth), lever = 1 + depth / outside;
  PortState s;
  double force = 0, low = 1e9, high = -1e9;
  for (int ms = 0; ms < 20'000; ++ms) {
    force = -tissue * std::max(0.0, 0.001 + lever * s.give.x);
    s = moved(m, s, {lever * force, 0, 0}, {0, 0, 0, depth}, outside, 1e-3 * ms, 1e-3);
    if (ms >= 19'000) low = std::min(low, force), high = std::max(high, force);
  }
  swing = high - low;
  return -force;
}

TEST(Port, ComesToRestWithTissueHoweverStiffAndDeepWhereTheLeversBalance) {
  for (const double tissue : {100.0, 1000.0, 10'000.0})
    for (const double depth : {0.03, 0.15, 0.25, 0.29}) {
      const double lever = 1 + depth / std::max(kLeastOutside, kLength - depth);
      double swing = 0;
      const double force = settled(tissue, 1000, depth, swing);
      EXPECT_NEAR(force, tissue * 0.001 / (1 + tissue * lever * lever / 1000), 1e-6 * force) << tissue << ' ' << depth;
      EXPECT_LT(swing, 1e-9) << tissue << ' ' << depth;
    }
}

TEST(Port, ARigidOneDoesNotMove) {
  EXPECT_FALSE(port(0, 0).moves());
  const PortState s = moved(port(0, 0), {}, {5, 5, 5}, {0, 0, 0, 0.1}, 0.2, 100, 1e-3);
  EXPECT_EQ(length(s.shift), 0);
}

}  // namespace
}  // namespace trocar::kinematics
