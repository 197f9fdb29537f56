#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include <trocar/fluids/smoke.hpp>

#include "within.hpp"

namespace trocar::fluids {
namespace {

struct Cavity {
  SmokeModel m = build(SmokeDescription{.origin = {-0.1, -0.1, 0}});
  SmokeState s = clear_air(m);
  SmokeWork w = make_work(m);
  void run(double seconds, double boiled_per_second, SmokeInput in = {}) {
    for (int t = 0; t < int(seconds * 1000 + 0.5); ++t) {
      if (boiled_per_second > 0) boil(m, {0.01, 0, 0.02}, boiled_per_second * 1e-3, s);
      advance(m, in, s, w);
    }
  }
};

TEST(Smoke, GathersAsSourceTimesTauOneMinusExp) {
  const double source = 8.8e-6;  // kg/s: 20 W
  for (const bool sucked : {false, true}) {
    Cavity c;
    const double tau = sucked ? 5 : 25;
    for (double t = 0; t < 40;) {
      c.run(5, source, {.sucked = sucked, .coagulating = true});
      t += 5;
      const double wanted = source * tau * (1 - std::exp(-t / tau));
      test::expect_within(
          "row 27, content, tau " + std::to_string(int(tau)) + " s, at " + std::to_string(int(t)) + " s",
          content(c.m, c.s), wanted, 0.01);
    }
  }
}

TEST(Smoke, HalvesInTauTimesLogTwo) {
  for (const bool sucked : {false, true}) {
    Cavity c;
    c.run(3, 1e-5);
    const double tau = sucked ? 5 : 25, first = content(c.m, c.s);
    double t = 0;
    for (; content(c.m, c.s) > first / 2; t += 0.008) c.run(0.008, 0, {.sucked = sucked});
    test::expect_within("row 27, half-life, tau " + std::to_string(int(tau)) + " s", t, tau * std::log(2.0), 0.01);
  }
}

TEST(Smoke, RisesATenthToAFifthOfAMetreASecond) {
  Cavity c;
  boil(c.m, {0, 0, 0.006}, 1e-6, c.s);
  const auto centre = [&] {
    double sum = 0, moment = 0;
    for (int i = 0; i < c.m.cells(); ++i) {
      sum += double(c.s.density[i]);
      moment += double(c.s.density[i]) * (i / (c.m.nx * c.m.ny) + 0.5) * c.m.cell;
    }
    return moment / sum;
  };
  const double before = centre();
  c.run(0.4, 0);
  const double speed = (centre() - before) / 0.4;
  EXPECT_GT(speed, 0.09);
  EXPECT_LT(speed, 0.2);
}

TEST(Smoke, SpreadsAndStaysWithinItsWalls) {
  Cavity c;
  boil(c.m, {0, 0, 0.006}, 1e-6, c.s);
  const double first = content(c.m, c.s);
  c.run(20, 0);
  EXPECT_NEAR(content(c.m, c.s) / first, std::exp(-20.0 / 25), 0.01 * std::exp(-20.0 / 25));
  const auto [low, high] = std::minmax_element(c.s.density.begin(), c.s.density.end());
  EXPECT_GE(*low, 0);
  const double top = density_at(c.m, c.s, {0.09, 0.09, 0.14}), bottom = density_at(c.m, c.s, {0.09, 0.09, 0.006});
  EXPECT_GT(top, 2 * bottom);  // it has gathered under the roof, in the corners too
  EXPECT_GT(top, 0.5 * double(*high));
}

TEST(Smoke, FiveSecondsOfCoagulationTakeAwayAThirdOfTheContrast) {
  Cavity c;
  c.run(5, 8.8e-6, {.coagulating = true});
  const double seen = visibility(c.m, c.s, {0.06, 0, 0.08}, {0.01, 0, 0.03});
  EXPECT_GT(seen, 0.3);
  EXPECT_LT(seen, 0.9);
}

TEST(Smoke, VisibilityIsTheExponentialOfDensityTimesWay) {
  Cavity c;
  std::fill(c.s.density.begin(), c.s.density.end(), 4.0f);
  EXPECT_NEAR(visibility(c.m, c.s, {-0.05, 0, 0.05}, {0.05, 0, 0.05}), std::exp(-0.7 * 4 * 0.1), 1e-6);
  EXPECT_EQ(visibility(c.m, c.s, {0, 0, 0.05}, {0, 0, 0.05}), 1);
}

TEST(LensFog, FollowsItsEquationAndAWarmLensTakesNone) {
  Cavity c;
  std::fill(c.s.density.begin(), c.s.density.end(), 8.0f);
  double fog = 0, on = 0;
  for (int t = 0; t < 10000; t += 8) {
    std::fill(c.s.density.begin(), c.s.density.end(), 8.0f);
    for (int k = 0; k < 8; ++k) advance(c.m, {.coagulating = true, .lens = {0, 0, 0.05}}, c.s, c.w);
    on += 0.008;
    fog += 0.008 * (5e-4 * 8 * on - fog / 15);
  }
  EXPECT_NEAR(c.s.fog, std::min(fog, 1.0), 0.01 * fog);
  EXPECT_GT(fog, 0.1);

  Cavity warm;
  for (int t = 0; t < 10000; ++t) {
    std::fill(warm.s.density.begin(), warm.s.density.end(), 8.0f);
    advance(warm.m, {.coagulating = true, .lens_temperature = 38, .lens = {0, 0, 0.05}}, warm.s, warm.w);
  }
  EXPECT_EQ(warm.s.fog, 0);
}

TEST(LensFog, AWipeClearsItInEightSeconds) {
  Cavity c;
  c.s.fog = 0.8;
  c.run(0.001, 0, {.wipe = true});
  c.run(3.999, 0);
  EXPECT_NEAR(c.s.fog, 0.4, 0.01);
  c.run(4.01, 0);
  EXPECT_LT(c.s.fog, 1e-9);
}

TEST(Smoke, RefusesNonsense) {
  Cavity c;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(boil(c.m, {nan, 0, 0}, 1e-6, c.s));
  EXPECT_FALSE(boil(c.m, {0, 0, 0}, nan, c.s));
  EXPECT_FALSE(boil(c.m, {0, 0, 0}, -1, c.s));
  EXPECT_TRUE(boil(c.m, {99, 99, 99}, 1e-9, c.s)) << "beyond the walls: the nearest cell";
  c.run(0.1, 0, {.lens_temperature = nan, .lens = {nan, nan, nan}});
  EXPECT_TRUE(std::isfinite(c.s.fog));
  EXPECT_THROW(build(SmokeDescription{.nx = 1}), std::invalid_argument);
  EXPECT_THROW(build(SmokeDescription{.cell = 0.001}), std::invalid_argument);
}

}  // namespace
}  // namespace trocar::fluids
