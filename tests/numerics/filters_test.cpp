#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/numerics/filters.hpp>

using namespace trocar;
using namespace trocar::numerics;

namespace {

constexpr double kRate = 50, kCutoff = 10;

/// Gain of one run at `frequency`, from the coefficients.
double gain(const LowPass& filter, double frequency) {
  const std::complex<double> back = std::polar(1.0, -2 * std::numbers::pi * frequency / kRate);  // 1 / z
  std::complex<double> product = 1;
  for (const Biquad& s : filter.sections)
    product *= (s.b0 + back * (s.b1 + back * s.b2)) / (1.0 + back * (s.a1 + back * s.a2));
  return std::abs(product);
}

std::vector<double> tone(double frequency, double phase, std::size_t n = 2000) {
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = std::sin(2 * std::numbers::pi * frequency * double(i) / kRate + phase);
  return x;
}

}  // namespace

TEST(LowPass, HasTheGainOfAButterworthFilter) {
  for (const int order : {2, 4, 8}) {
    const LowPass filter = butterworth_low_pass(order, kCutoff, kRate);
    for (const double f : {0.0, 1.0, 5.0, 10.0, 15.0, 20.0, 24.0}) {
      const double warped = std::tan(std::numbers::pi * f / kRate) / std::tan(std::numbers::pi * kCutoff / kRate);
      EXPECT_NEAR(gain(filter, f), 1 / std::sqrt(1 + std::pow(warped, 2 * order)), 1e-12) << order << ' ' << f;
    }
  }
}

TEST(LowPass, HalvesATonesAmplitudeAtTheCutOffAndDoesNotShiftIt) {
  const LowPass filter = butterworth_low_pass(4, kCutoff, kRate);
  for (const double f : {2.0, 10.0, 15.0}) {
    const double expected = gain(filter, f) * gain(filter, f);
    if (f == kCutoff) {
      EXPECT_NEAR(expected, 0.5, 1e-12);
    }
    const std::vector<double> in = tone(f, 0.3);
    std::vector<double> out = in;
    filter_zero_phase(filter, out);
    for (std::size_t i = 200; i + 200 < in.size(); ++i) ASSERT_NEAR(out[i], expected * in[i], 1e-9) << f;
  }
}

TEST(LowPass, LeavesConstantsAlone) {
  const LowPass filter = butterworth_low_pass(4, kCutoff, kRate);
  for (const std::size_t n : {1u, 2u, 5u, 15u, 16u, 300u}) {
    std::vector<double> x(n, -0.137);
    filter_zero_phase(filter, x);
    for (const double v : x) EXPECT_NEAR(v, -0.137, 1e-14) << n;
  }
}

TEST(LowPass, IsLinearAndTheSameBackwards) {
  const LowPass filter = butterworth_low_pass(4, kCutoff, kRate);
  core::Random random(3);
  std::vector<double> x(400), y(400);
  for (double& v : x) v = random.uniform(-1, 1);
  for (double& v : y) v = random.uniform(-1, 1);
  std::vector<double> sum(400), backwards(x.rbegin(), x.rend());
  for (std::size_t i = 0; i < 400; ++i) sum[i] = 2 * x[i] - 3 * y[i];
  for (std::vector<double>* v : {&x, &y, &sum, &backwards}) filter_zero_phase(filter, *v);
  for (std::size_t i = 0; i < 400; ++i) EXPECT_NEAR(sum[i], 2 * x[i] - 3 * y[i], 1e-12);
  for (std::size_t i = 40; i < 360; ++i) EXPECT_NEAR(backwards[399 - i], x[i], 1e-8) << "far from the ends";
}

TEST(LowPass, RefusesWhatIsNoFilter) {
  EXPECT_THROW(butterworth_low_pass(3, 10, 50), std::invalid_argument);
  EXPECT_THROW(butterworth_low_pass(4, 25, 50), std::invalid_argument);
  EXPECT_THROW(butterworth_low_pass(4, 0, 50), std::invalid_argument);
  EXPECT_THROW(butterworth_low_pass(4, NAN, 50), std::invalid_argument);
}
