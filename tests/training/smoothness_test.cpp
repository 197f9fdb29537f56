// Published vectors and properties of the smoothness measures.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/training/metrics/smoothness.hpp>

using namespace trocar;
using namespace trocar::training;

namespace {

/// The example that comes with the authors' program: v = exp(-5 t^2), t = -1, -0.99 .. 0.99.
std::vector<double> bell() {
  std::vector<double> v(200);
  for (int i = 0; i < 200; ++i) {
    const double t = -1 + 0.01 * i;
    v[std::size_t(i)] = std::exp(-5 * t * t);
  }
  return v;
}

/// Speed of the minimum-jerk movement: 30 (u^2 - 2 u^3 + u^4), u = 0..1, peak 1.875.
std::vector<double> minimum_jerk(std::size_t n) {
  std::vector<double> v(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double u = double(i) / double(n - 1);
    v[i] = 30 * u * u * (1 - u) * (1 - u);
  }
  return v;
}

std::vector<double> scaled(std::vector<double> v, double factor) {
  for (double& x : v) x *= factor;
  return v;
}

}  // namespace

TEST(Smoothness, PublishedBellGivesThePublishedFigures) {
  EXPECT_NEAR(spectral_arc_length(bell(), 100), -1.41403, 1e-5);
  EXPECT_NEAR(dimensionless_jerk(bell(), 100), -335.74684, 1e-5);
  EXPECT_NEAR(log_dimensionless_jerk(bell(), 100), -5.81636, 1e-5);
}

TEST(Smoothness, MinimumJerkMovementConvergesToItsClosedForm) {
  // -ln 204.8; the sums' error is of first order in 1/n, so the error must halve and extrapolation must remove it.
  const double exact = -std::log(204.8);
  const double coarse = log_dimensionless_jerk(minimum_jerk(20001), 20000);
  const double fine = log_dimensionless_jerk(minimum_jerk(40001), 40000);
  EXPECT_NEAR((coarse - exact) / (fine - exact), 2, 0.01);
  EXPECT_NEAR(2 * fine - coarse, exact, 1e-5);
}

TEST(Smoothness, DoesNotDependOnSizeOrDuration) {
  core::Random random(5);
  std::vector<double> v = bell();
  for (double& x : v) x += 0.02 * random.uniform();
  for (const double factor : {0.001, 60.0, 1000.0}) {
    EXPECT_NEAR(spectral_arc_length(scaled(v, factor), 100), spectral_arc_length(v, 100), 1e-9);
    EXPECT_NEAR(log_dimensionless_jerk(scaled(v, factor), 100), log_dimensionless_jerk(v, 100), 1e-9);
  }
  EXPECT_NEAR(log_dimensionless_jerk(v, 25), log_dimensionless_jerk(v, 100), 1e-9) << "four times as slow";
}

TEST(Smoothness, HesitationAndTremorAreLessSmooth) {
  std::vector<double> hesitant(400), trembling = bell();
  for (std::size_t i = 0; i < 400; ++i) {
    const double t = -2 + 0.01 * double(i), a = t + 0.8, b = t - 0.8;
    hesitant[i] = std::exp(-5 * a * a) + std::exp(-5 * b * b);
  }
  for (std::size_t i = 0; i < trembling.size(); ++i)
    trembling[i] += 0.05 * std::sin(2 * std::numbers::pi * 6 * 0.01 * double(i));
  for (const std::vector<double>& worse : {hesitant, trembling}) {
    EXPECT_LT(spectral_arc_length(worse, 100), spectral_arc_length(bell(), 100) - 0.05);
    EXPECT_LT(log_dimensionless_jerk(worse, 100), log_dimensionless_jerk(bell(), 100) - 0.5);
  }
}

TEST(Smoothness, FrequenciesAboveTheCutOffAreNotLookedAt) {
  std::vector<double> v(1000);
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = std::exp(-2e-5 * (double(i) - 500) * (double(i) - 500));
  const double smooth = spectral_arc_length(v, 100);
  for (std::size_t i = 0; i < v.size(); ++i) v[i] *= 1 + 0.5 * std::sin(2 * std::numbers::pi * 20 * 0.01 * double(i));
  EXPECT_NEAR(spectral_arc_length(v, 100), smooth, 1e-3);
  EXPECT_LT(spectral_arc_length(v, 100, {.cutoff = 25}), smooth - 0.3);
}

TEST(Smoothness, WithoutMotionThereIsNoFigure) {
  const std::vector<double> still(100, 0.0), constant(100, 0.3), two{1, 2};
  EXPECT_TRUE(std::isnan(spectral_arc_length(still, 50)));
  EXPECT_TRUE(std::isnan(log_dimensionless_jerk(still, 50)));
  EXPECT_TRUE(std::isnan(log_dimensionless_jerk(constant, 50)));
  EXPECT_TRUE(std::isnan(log_dimensionless_jerk(two, 50)));
  EXPECT_TRUE(std::isnan(spectral_arc_length({}, 50)));
  EXPECT_TRUE(std::isnan(spectral_arc_length(std::vector<double>(70'000, 1.0), 50)));
}

TEST(Movements, SplitWhereTheSpeedFallsBelowAShareOfItsPeak) {
  std::vector<double> v(500, 0.001);
  for (std::size_t i = 50; i < 100; ++i) v[i] = 1;
  for (std::size_t i = 200; i < 300; ++i) v[i] = 0.06;
  for (std::size_t i = 400; i < 412; ++i) v[i] = 1;    // too short: 0.24 s
  for (std::size_t i = 487; i < 500; ++i) v[i] = 0.5;  // 0.26 s, up to the end
  const std::vector<Movement> found = movements(v, 50);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].first, 50u);
  EXPECT_EQ(found[0].count, 50u);
  EXPECT_EQ(found[1].first, 200u);
  EXPECT_EQ(found[1].count, 100u);
  EXPECT_EQ(found[2].first, 487u);
  EXPECT_EQ(found[2].count, 13u);
  EXPECT_TRUE(movements(std::vector<double>(100, 0.0), 50).empty());
}
