#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/numerics/fft.hpp>

using namespace trocar;
using namespace trocar::numerics;

namespace {

std::vector<Complex> random_signal(std::size_t n, std::uint64_t seed) {
  core::Random random(seed);
  std::vector<Complex> x(n);
  for (Complex& c : x) {
    c.re = random.uniform(-1, 1);
    c.im = random.uniform(-1, 1);
  }
  return x;
}

/// The definition, term by term.
std::vector<Complex> slow_transform(const std::vector<Complex>& x) {
  std::vector<Complex> sums(x.size());
  for (std::size_t k = 0; k < x.size(); ++k)
    for (std::size_t j = 0; j < x.size(); ++j) {
      const double angle = -2 * std::numbers::pi * double(j * k % x.size()) / double(x.size());
      const double c = std::cos(angle), s = std::sin(angle);
      sums[k].re += x[j].re * c - x[j].im * s;
      sums[k].im += x[j].re * s + x[j].im * c;
    }
  return sums;
}

}  // namespace

TEST(Fft, AgreesWithTheDefinitionAtEverySize) {
  for (std::size_t n = 1; n <= 512; n *= 2) {
    std::vector<Complex> x = random_signal(n, n);
    const std::vector<Complex> expected = slow_transform(x);
    fft(x);
    for (std::size_t k = 0; k < n; ++k) {
      EXPECT_NEAR(x[k].re, expected[k].re, 1e-14 * double(n)) << n;
      EXPECT_NEAR(x[k].im, expected[k].im, 1e-14 * double(n)) << n;
    }
  }
}

TEST(Fft, KeepsEnergy) {
  std::vector<Complex> x = random_signal(1 << 14, 7);
  const auto energy = [](const std::vector<Complex>& v) {
    double sum = 0;
    for (const Complex& c : v) sum += c.re * c.re + c.im * c.im;
    return sum;
  };
  const double before = energy(x);
  fft(x);
  EXPECT_NEAR(energy(x) / double(x.size()) / before, 1, 1e-12);
}

TEST(Fft, AToneFillsItsOwnBinOnly) {
  const std::size_t n = 256;
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = std::sin(2 * std::numbers::pi * 20 * double(i) / double(n));
  const std::vector<double> m = magnitude_spectrum(x, n);
  ASSERT_EQ(m.size(), n / 2 + 1);
  for (std::size_t k = 0; k < m.size(); ++k) EXPECT_NEAR(m[k], k == 20 ? double(n) / 2 : 0, 1e-11) << k;
}

TEST(Fft, RefusesSizesThatAreNoPowerOfTwo) {
  std::vector<Complex> three(3), none;
  EXPECT_THROW(fft(three), std::invalid_argument);
  EXPECT_THROW(fft(none), std::invalid_argument);
  EXPECT_EQ(fft_size(200), 256u);
  EXPECT_EQ(fft_size(256), 256u);
}
