#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/devices/follower.hpp>

using namespace trocar::devices;

namespace {
constexpr double kTick = 0.001, kTau = 0.010;
const double kGain = follower_gain(kTick, kTau);
}  // namespace

TEST(Follower, ApproachesAStepLikeACriticallyDampedSystem) {
  Follower<1> state;
  double worst = 0;
  for (int tick = 1; tick <= 200; ++tick) {
    follow(state, {1.0}, kGain);
    const double t = tick * kTick / kTau;
    worst = std::max(worst, std::abs(state.x[0] - (1 - (1 + t) * std::exp(-t))));
  }
  EXPECT_LT(worst, 0.03);  // first order in dt / tau = 0.1
}

TEST(Follower, ConvergesToTheClosedFormWithFirstOrder) {
  const auto error = [](int refine) {
    Follower<1> state;
    const double dt = kTick / refine;
    for (int i = 0; i < 20 * refine; ++i) follow(state, {1.0}, follower_gain(dt, kTau));
    return std::abs(state.x[0] - (1 - 3 * std::exp(-2.0)));
  };
  EXPECT_NEAR(error(8) / error(16), 2.0, 0.1);
}

TEST(Follower, NeverOvershootsAndNeverTurnsBack) {
  for (const double tau : {0.0, 1e-6, 0.003, 0.01, 1.0}) {
    Follower<1> state;
    double before = 0;
    for (int tick = 0; tick < 5000; ++tick) {
      follow(state, {1.0}, follower_gain(kTick, tau));
      EXPECT_GE(state.x[0], before);
      EXPECT_LE(state.x[0], 1.0);
      before = state.x[0];
    }
    if (tau <= 0.01) {
      EXPECT_NEAR(before, 1, 1e-12);
    }
  }
}

TEST(Follower, LagsARampByTwoTimeConstants) {
  Follower<1> state;
  double target = 0;
  for (int tick = 1; tick <= 1000; ++tick) follow(state, {target = 0.1 * tick * kTick}, kGain);
  EXPECT_NEAR(target - state.x[0], 0.1 * 2 * kTau, 1e-9);
}

TEST(Follower, TurnsDisplayRateStepsIntoSmoothTicks) {
  Follower<1> state;
  double largest = 0, before = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    follow(state, {double(tick / 16)}, kGain);  // one unit at each picture
    if (tick > 200) largest = std::max(largest, state.x[0] - before);
    before = state.x[0];
  }
  EXPECT_LT(largest, 2.0 / 16);  // of a mean of 1/16 a tick; unsmoothed it would be 1
}

TEST(Follower, RestsWhereItIsPut) {
  Follower<2> state = resting<2>({0.3, -4});
  for (int tick = 0; tick < 100; ++tick) follow(state, {0.3, -4}, kGain);
  EXPECT_EQ(state.x, (std::array<double, 2>{0.3, -4}));
}
