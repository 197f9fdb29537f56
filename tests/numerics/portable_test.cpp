// Accuracy is measured against long double libm, in units of the last place of the true result.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <trocar/core/hash.hpp>
#include <trocar/core/random.hpp>
#include <trocar/numerics/portable.hpp>

namespace portable = trocar::portable;
using trocar::core::Random;

namespace {

double ulps(double got, long double truth) {
  const double rounded = std::fabs(double(truth));
  const double ulp = std::nextafter(rounded, std::numeric_limits<double>::infinity()) - rounded;
  return double(std::fabs((long double)(got)-truth) / (long double)(ulp));
}

template <class Mine, class Truth>
double worst(Mine mine, Truth truth, double low, double high, int samples = 200000) {
  Random random(42);
  double result = 0.0;
  for (int i = 0; i < samples; ++i) {
    const double x = random.uniform(low, high);
    result = std::fmax(result, ulps(mine(x), truth((long double)(x))));
  }
  return result;
}
const auto lsin = [](long double x) { return std::sin(x); };
const auto lcos = [](long double x) { return std::cos(x); };

}  // namespace

TEST(Portable, SineAndCosineAreWithinOneUlpUpTo1e4) {
  for (double range : {0.5, 4.0, 100.0, 1e4}) {
    EXPECT_LT(worst(portable::sin, lsin, -range, range), 1.0) << range;
    EXPECT_LT(worst(portable::cos, lcos, -range, range), 1.0) << range;
  }
}

TEST(Portable, SineAndCosineStayRelativelyAccurateAtTheirZeros) {
  for (int k = -6366; k <= 6366; ++k) {
    const double x = k * (portable::pi / 2);
    if (k % 2 == 0 && k != 0) {
      EXPECT_LT(ulps(portable::sin(x), std::sin((long double)(x))), 4.0) << k;
    }
    if (k % 2 != 0) {
      EXPECT_LT(ulps(portable::cos(x), std::cos((long double)(x))), 4.0) << k;
    }
  }
}

TEST(Portable, ArcFunctionsAreWithinTwoUlp) {
  EXPECT_LT(worst(
                portable::asin, [](long double x) { return std::asin(x); }, -1, 1),
            3.0);
  EXPECT_LT(worst(
                portable::acos, [](long double x) { return std::acos(x); }, -1, 1),
            3.0);
  Random random(7);
  for (int i = 0; i < 400000; ++i) {
    const double scale = portable::exp(random.uniform(-40, 40));
    const double x = random.uniform(-1, 1) * scale, y = random.uniform(-1, 1);
    ASSERT_LT(ulps(portable::atan2(y, x), std::atan2((long double)(y), (long double)(x))), 2.0) << y << ' ' << x;
  }
}

TEST(Portable, ArcFunctionsClampAndAgreeWithTheStandardOnAxes) {
  EXPECT_EQ(portable::acos(1.5), 0.0);
  EXPECT_EQ(portable::acos(-1.5), portable::pi);
  EXPECT_EQ(portable::asin(2.0), portable::pi / 2);
  const double infinity = std::numeric_limits<double>::infinity();
  for (double y : {0.0, -0.0, 1.0, -1.0, infinity, -infinity, 1e308, 5e-324})
    for (double x : {0.0, -0.0, 1.0, -1.0, infinity, -infinity, 1e308, 5e-324}) {
      EXPECT_DOUBLE_EQ(portable::atan2(y, x), std::atan2(y, x)) << y << ' ' << x;
      EXPECT_EQ(std::signbit(portable::atan2(y, x)), std::signbit(std::atan2(y, x))) << y << ' ' << x;
    }
}

TEST(Portable, ExponentialIsWithinOneUlpAndClampsAtItsEnds) {
  for (double range : {0.1, 1.0, 20.0, 708.0})
    EXPECT_LT(worst(
                  portable::exp, [](long double x) { return std::exp(x); }, -range, range),
              1.0)
        << range;
  EXPECT_EQ(portable::exp(0.0), 1.0);
  EXPECT_EQ(portable::exp(-709.0), 0.0);
  EXPECT_EQ(portable::exp(1e9), portable::exp(709.0));
  EXPECT_TRUE(std::isfinite(portable::exp(709.0)));
}

TEST(Portable, LogarithmIsWithinOneUlpAlsoNearOneAndForDenormals) {
  const auto truth = [](long double x) { return std::log(x); };
  EXPECT_LT(worst(portable::log, truth, 0.5, 2.0), 1.0);
  EXPECT_LT(worst(portable::log, truth, 0.999999, 1.000001), 1.0);
  EXPECT_LT(worst(portable::log, truth, 1e-300, 1e-290), 1.0);
  EXPECT_LT(worst(portable::log, truth, 5e-324, 1e-310), 1.0);
  EXPECT_LT(worst(portable::log, truth, 1.0, 1e300), 1.0);
  EXPECT_EQ(portable::log(1.0), 0.0);
}

TEST(Portable, BadArgumentsGiveNanInsteadOfNonsense) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(portable::sin(nan)));
  EXPECT_TRUE(std::isnan(portable::cos(1e300)));
  EXPECT_TRUE(std::isnan(portable::exp(nan)));
  EXPECT_TRUE(std::isnan(portable::log(-1.0)));
  EXPECT_TRUE(std::isnan(portable::atan2(nan, 1.0)));
  EXPECT_TRUE(std::isnan(portable::acos(nan)));
}

// The value was printed once by gcc 12 on x86-64; every other compiler and machine must find the same.
TEST(Portable, GivesTheSameBitsOnEveryCompiler) {
  trocar::core::Hasher hasher;
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const double x = random.uniform(-100, 100), y = random.uniform(-1, 1);
    hasher.add(portable::sin(x));
    hasher.add(portable::cos(x));
    hasher.add(portable::atan2(x, y));
    hasher.add(portable::acos(y));
    hasher.add(portable::asin(y));
    hasher.add(portable::exp(x));
    hasher.add(portable::log(x * x));
  }
  EXPECT_EQ(hasher.value(), 0xb99648b4d5f38873ull) << std::hex << hasher.value();
}
