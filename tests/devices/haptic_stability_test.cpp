// Energy and shaking of a device at a stiff wall.  [Colgate & Schenkel 1994]  [Hannaford & Ryu 2002]
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <trocar/devices/haptics/force_renderer.hpp>
#include <trocar/devices/haptics/simulated_device.hpp>

using namespace trocar;
using namespace trocar::devices;

namespace {

constexpr double kHapticPeriod = 1e-3;

LocalModel floor_of(double stiffness) {
  LocalModel m;
  m.plane[0] = {{0, 0, 0}, {0, 0, 1}};
  m.planes = 1;
  m.stiffness = stiffness;
  return m;
}

ForceRenderer::Settings settings_of(bool passivity) {
  return {.period = kHapticPeriod, .passivity = passivity, .limit_stiffness = false, .rate_max = 1e9};
}

struct Press {
  double shake_early = 0, shake_late = 0;  ///< largest excursion about the mean, in a first and in a last second [m]
  double work = 0;                         ///< of the force on the device [J]
  double deepest = 0;                      ///< [m]
};

/// A hand leans on a wall 3 mm deep for three seconds, and lets go.
Press lean_on(double stiffness, double damping, bool passivity) {
  SimulatedDevice device({.mass = 0.2,
                          .hand_stiffness = 200,
                          .hand_damping = 0,
                          .own_damping = damping,
                          .resolution = 1e-6,
                          .force_max = 1000});
  ForceRenderer renderer(device.capabilities(), settings_of(passivity));
  const LocalModel wall = floor_of(stiffness);
  Press result;
  HapticSample sample;
  const auto run = [&](int ticks, Vec3d hand, double* shake) {
    double least = std::numeric_limits<double>::max(), most = -least;
    for (int i = 0; i < ticks; ++i) {
      device.lead(hand);
      device.read(sample);
      device.write(renderer.force(sample, wall, 0));
      if (!finite(device.position())) break;
      least = std::min(least, device.position().z);
      most = std::max(most, device.position().z);
      result.deepest = std::min(result.deepest, device.position().z);
    }
    if (shake) *shake = most - least;
  };
  run(300, {0, 0, 0.005}, nullptr);
  run(500, {0, 0, -0.003}, nullptr);
  run(250, {0, 0, -0.003}, &result.shake_early);
  run(2000, {0, 0, -0.003}, nullptr);
  run(250, {0, 0, -0.003}, &result.shake_late);
  run(1500, {0, 0, 0.005}, nullptr);
  result.work = device.work();
  return result;
}

/// Held tissue, which pulls both ways, so that nothing bounds what grows: the largest excursion in a quarter of a
/// second from `from` on [m].
double swing(double stiffness, double damping, bool passivity, int from) {
  SimulatedDevice device(
      {.mass = 0.2, .hand_stiffness = 200, .hand_damping = 0, .own_damping = damping, .resolution = 0});
  ForceRenderer renderer(device.capabilities(), settings_of(passivity));
  LocalModel held;
  held.holds = 1;
  held.held_stiffness = stiffness;
  device.lead({0, 0, 0.001});
  HapticSample sample;
  double most = 0;
  for (int i = 0; i < from + 250; ++i) {
    device.read(sample);
    if (i == 20) device.lead({0, 0, 0});
    HapticForce force = renderer.force(sample, held, 0);
    device.write(force);
    if (i >= from) most = std::max(most, length(device.position()));
  }
  return most;
}

}  // namespace

// K = 4000 N/m at 1 kHz: K T / 2 = 2 N s/m.
TEST(HapticWall, SwingsMoreAndMoreWhereDampingIsBelowHalfOfStiffnessTimesPeriod) {
  const double early = swing(4000, 1.5, false, 250), late = swing(4000, 1.5, false, 1500);
  EXPECT_GT(early, 1e-6);
  EXPECT_GT(late, 3 * early);
}

TEST(HapticWall, ComesToRestWhereDampingIsAbove) {
  EXPECT_LT(swing(4000, 2.5, false, 1500), 0.4 * swing(4000, 2.5, false, 250));
  EXPECT_LT(lean_on(4000, 4, false).shake_late, 2e-5);
}

TEST(HapticWall, NeverSettlesOnAWallWhereDampingIsBelowAndMakesEnergy) {
  const Press p = lean_on(4000, 0.5, false);
  EXPECT_GT(p.shake_late, 0.001);
  EXPECT_GT(p.work, 0.001);
}

TEST(HapticWall, ComesToRestEitherWayWithPassivityControl) {
  for (const double damping : {0.5, 4.0}) {
    const Press p = lean_on(4000, damping, true);
    EXPECT_LT(p.shake_late, 2e-4) << damping;
    EXPECT_LT(p.deepest, -1e-5) << damping;  // it was pressed
    EXPECT_LT(swing(4000, damping, true, 1500), 1e-4) << damping;
  }
}

TEST(HapticWall, APressAndReleaseGivesNothingBackThatWasNotPutInWithPassivityControl) {
  for (const double stiffness : {500.0, 2000.0, 4000.0, 8000.0})
    for (const double damping : {0.2, 0.5, 2.0, 6.0}) {
      const Press p = lean_on(stiffness, damping, true);
      EXPECT_LE(p.work, 2e-4) << stiffness << " N/m, " << damping << " N s/m";
    }
}

TEST(HapticWall, ColgatesConditionIsTheStiffnessAtWhichAnUndampedSpringStopsComingToRest) {
  HapticCapabilities device;
  for (const double damping : {1.0, 2.0, 4.0}) {
    device.own_damping = damping;
    const double limit = stiffest_passive(device, kHapticPeriod, 0);
    EXPECT_DOUBLE_EQ(limit, 2 * damping / kHapticPeriod);
    const auto grows = [damping](double k) { return swing(k, damping, false, 1500) / swing(k, damping, false, 750); };
    EXPECT_LT(grows(0.95 * limit), 1) << damping;
    EXPECT_GT(grows(1.05 * limit), 1) << damping;
  }
}

TEST(HapticWall, StiffnessIsLimitedByTheMechanismsFrictionPerStepOfItsPosition) {
  HapticCapabilities device;
  device.own_damping = 5;
  device.own_friction = 0.01;
  device.resolution = 1e-5;
  EXPECT_DOUBLE_EQ(stiffest_passive(device, kHapticPeriod, 0), 2000);  // [Abbott & Okamura 2005] 2 f_c / resolution
  EXPECT_DOUBLE_EQ(stiffest_passive(device, kHapticPeriod, 4.5), 1000);
  EXPECT_EQ(stiffest_passive(device, kHapticPeriod, 6), 0);
}

TEST(HapticGuard, FadesInIsBoundedAndIsGoneATenthOfASecondAfterEitherSideFellSilent) {
  ForceGuard guard({.force_max = 3, .rate_max = 1e9, .patience = 0.05, .fade = 0.1});
  EXPECT_LT(length(guard.guard({9, 0, 0}, 0, kHapticPeriod)), 0.2);
  for (int i = 0; i < 200; ++i) guard.guard({9, 0, 0}, 0, kHapticPeriod);
  EXPECT_DOUBLE_EQ(guard.guard({9, 0, 0}, 0, kHapticPeriod).x, 3);
  EXPECT_DOUBLE_EQ(guard.guard({9, 0, 0}, 0.049, kHapticPeriod).x, 3);
  double silence = 0.051, force = 3;
  for (int i = 0; i < 101; ++i, silence += kHapticPeriod) {
    const double now = guard.guard({2, 0, 0}, silence, kHapticPeriod).x;
    EXPECT_LE(now, force);
    force = now;
  }
  EXPECT_LT(force, 1e-9);
}

TEST(HapticGuard, GrowsNoFasterThanItsRateAndEndsAtOnce) {
  ForceGuard guard({.force_max = 10, .rate_max = 500, .patience = 0.05, .fade = 1e-9});
  double last = 0;
  for (int i = 0; i < 10; ++i) {
    const double now = guard.guard({0, 4, 0}, 0, kHapticPeriod).y;
    EXPECT_LE(now - last, 0.5 + 1e-12);
    last = now;
  }
  EXPECT_DOUBLE_EQ(last, 4);
  EXPECT_EQ(guard.guard({0, 0, 0}, 0, kHapticPeriod).y, 0);
  EXPECT_EQ(length(guard.guard({std::nan(""), 0, 0}, 0, kHapticPeriod)), 0);
}

TEST(HapticRenderer, WhatIsHeldPullsBothWaysAndASealHoldsBackWithItsFrictionWhicheverWay) {
  const SimulatedDevice device;
  ForceRenderer renderer(device.capabilities(), {.passivity = false, .rate_max = 1e9});
  LocalModel m;
  m.holds = 1;
  m.held_stiffness = 100;
  HapticSample sample;
  for (int i = 0; i < 200; ++i) renderer.force(sample, m, 0);
  sample.position = {0.01, 0, 0};
  EXPECT_NEAR(renderer.force(sample, m, 0).force.x, -1, 1e-9);
  sample.position = {-0.01, 0, 0};
  EXPECT_NEAR(renderer.force(sample, m, 0).force.x, 1, 1e-9);

  LocalModel sealed;
  sealed.port = {0, 0, 0.1};
  sealed.seal_friction = 0.5;
  sample.position = {0, 0, 0};
  for (int i = 0; i < 50; ++i) sample.position.z -= 1e-4, renderer.force(sample, sealed, 0);
  EXPECT_NEAR(renderer.force(sample, sealed, 0).force.z, 0.5, 1e-9);  // going in, it pushes out
  for (int i = 0; i < 50; ++i) sample.position.z += 1e-4, renderer.force(sample, sealed, 0);
  EXPECT_NEAR(renderer.force(sample, sealed, 0).force.z, -0.5, 1e-9);
}

TEST(HapticRenderer, LessCountsAtOnceAndMoreFadesInSlowly) {
  HapticCapabilities strong;
  strong.force_max = 5, strong.own_damping = 5;
  ForceRenderer renderer(strong, {.passivity = false, .rate_max = 1e9});
  const LocalModel m = floor_of(800);
  HapticSample sample;
  sample.position = {0, 0, -0.02};
  for (int i = 0; i < 200; ++i) renderer.force(sample, m, 0);
  EXPECT_NEAR(renderer.force(sample, m, 0).force.z, 5, 1e-9);
  HapticCapabilities weak = strong;
  weak.force_max = 0.1;
  renderer.adapt(weak);
  EXPECT_NEAR(renderer.force(sample, m, 0).force.z, 0.1, 1e-9);
  renderer.adapt(strong);
  double before = 0.1;
  int periods = 0;
  for (; periods < 2000 && renderer.force_limit() < 5; ++periods) {
    const double now = renderer.force(sample, m, 0).force.z;
    ASSERT_LE(now - before, 5 * kHapticPeriod / ForceRenderer::kGrowth + 1e-9);
    before = now;
  }
  EXPECT_NEAR(periods * kHapticPeriod, 0.98 * ForceRenderer::kGrowth, 0.01);
}

TEST(HapticRenderer, APointThatIsDraggedOverAPlaneIsHeldBackByCoulombsShareOfThePress) {
  const SimulatedDevice device;
  ForceRenderer renderer(device.capabilities(), {.passivity = false, .rate_max = 1e9});
  LocalModel m = floor_of(500);
  m.rubbing = 0.2;
  HapticSample sample;
  sample.position = {0, 0, -0.004};
  for (int i = 0; i < 200; ++i) renderer.force(sample, m, 0);
  for (int i = 0; i < 100; ++i) sample.position.x += 1e-4, renderer.force(sample, m, 0);
  const Vec3d f = renderer.force(sample, m, 0).force;
  EXPECT_NEAR(f.z, 2, 1e-6);
  EXPECT_NEAR(f.x, -0.4, 1e-3);
}
