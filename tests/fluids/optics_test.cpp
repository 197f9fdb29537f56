#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/fluids/optics.hpp>

namespace trocar::fluids {
namespace {

TEST(BeerLambert, TransmissionIsTheExponentialOfDepth) {
  const Optics o;
  for (double f : {0.0, 0.002, 0.05, 1.0})
    for (double path : {0.0, 1e-4, 1e-3, 0.01}) {
      const Rgb t = transmission(o, {.blood = f}, path);
      EXPECT_NEAR(t.r, std::exp(-0.8e3 * f * path), 1e-6);
      EXPECT_NEAR(t.g, std::exp(-28e3 * f * path), 1e-6);
      EXPECT_NEAR(t.b, std::exp(-24e3 * f * path), 1e-6);
    }
}

TEST(BeerLambert, DepthsAddUp) {
  const Optics o;
  core::Random r(3);
  for (int n = 0; n < 10000; ++n) {
    const Shares s{.blood = 0.1 * r.uniform(), .bile = 0.5 * r.uniform(), .saturation = r.uniform(0.6, 1)};
    const double a = r.uniform(0, 0.01), b = r.uniform(0, 0.01);
    const Rgb one = transmission(o, s, a), other = transmission(o, s, b), both = transmission(o, s, a + b);
    EXPECT_NEAR(both.r, one.r * other.r, 1e-6);
    EXPECT_NEAR(both.g, one.g * other.g, 1e-6);
    EXPECT_NEAR(both.b, one.b * other.b, 1e-6);
  }
}

TEST(BeerLambert, TwoPerMilleOfBloodInTenMillimetresIsPinkAndFivePercentRed) {
  const Optics o;
  const Rgb pale = transmission(o, {.blood = 0.002}, 0.020);  // 10 mm down and up
  EXPECT_NEAR(pale.g, 0.33, 0.01);
  EXPECT_GT(pale.r, 0.95);
  const Rgb white{0.8, 0.8, 0.8}, red = seen_through(o, {.blood = 0.05}, 0.020, white);
  EXPECT_GT(red.r, 20 * red.g);
  const Rgb bottomless = seen_through(o, {.blood = 1}, 0.1, white);
  EXPECT_NEAR(bottomless.r, 0.12, 0.01);
  // A pool in real pictures is (87, 15, 16) in sRGB.
  EXPECT_NEAR(bottomless.r / bottomless.g, 0.0953 / 0.0048, 2);
  EXPECT_NEAR(bottomless.r / bottomless.b, 0.0953 / 0.0052, 2);
}

TEST(BeerLambert, VenousBloodIsDarkerInRed) {
  const Optics o;
  EXPECT_LT(transmission(o, {.blood = 1, .saturation = 0.70}, 1e-3).r,
            transmission(o, {.blood = 1, .saturation = 0.98}, 1e-3).r);
}

TEST(BeerLambert, BileLooksGreenish) {
  const Rgb c = seen_through(Optics{}, {.bile = 1}, 0.004, {0.8, 0.8, 0.8});
  EXPECT_GT(c.g, 4 * c.b);
  EXPECT_GT(c.r, c.b);
}

TEST(BeerLambert, NonsenseLetsLightThrough) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Rgb t = transmission(Optics{}, {.blood = nan, .bile = nan}, nan);
  EXPECT_EQ(t.r, 1);
  EXPECT_EQ(transmission(Optics{}, {.blood = 1}, -1).g, 1);
}

TEST(Clot, DarkensToTwoFifthsBetweenThreeAndFiveMinutes) {
  EXPECT_EQ(clot_brightness(0), 1);
  EXPECT_EQ(clot_brightness(180), 1);
  EXPECT_NEAR(clot_brightness(240), 0.7, 1e-12);
  EXPECT_NEAR(clot_brightness(300), 0.4, 1e-12);
  EXPECT_NEAR(clot_brightness(5000), 0.4, 1e-12);
}

}  // namespace
}  // namespace trocar::fluids
