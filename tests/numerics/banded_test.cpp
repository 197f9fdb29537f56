#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/numerics/banded.hpp>

using namespace trocar::numerics;

namespace {

// Symmetric, diagonally dominant, hence positive definite.
std::vector<double> random_band(int n, int half, trocar::core::Random& random) {
  std::vector<double> a(band_size(n, half), std::numeric_limits<double>::quiet_NaN());  // unused corner stays NaN
  for (int i = 0; i < n; ++i) {
    for (int j = std::max(0, i - half); j < i; ++j) a[band_at(half, i, j)] = random.uniform(-1, 1);
    a[band_at(half, i, i)] = 2.0 * half + random.uniform(0.1, 1.0);
  }
  return a;
}
double entry(const std::vector<double>& a, int half, int i, int j) {
  if (i < j) std::swap(i, j);
  return i - j > half ? 0.0 : a[band_at(half, i, j)];
}

}  // namespace

TEST(Banded, SolutionSatisfiesTheSystemForAnyBandwidthAndColumns) {
  trocar::core::Random random(1);
  for (int n : {1, 2, 5, 40})
    for (int half : {0, 1, 2, 6, 8, 11})
      for (int columns : {1, 3}) {
        const auto a = random_band(n, half, random);
        std::vector<double> b(n * columns), x, factor = a;
        for (double& value : b) value = random.uniform(-1, 1);
        x = b;
        ASSERT_EQ(band_factor(n, half, factor.data()), -1);
        band_solve(n, half, factor.data(), x.data(), columns);
        for (int i = 0; i < n; ++i)
          for (int c = 0; c < columns; ++c) {
            double sum = 0;
            for (int j = 0; j < n; ++j) sum += entry(a, half, i, j) * x[j * columns + c];
            ASSERT_NEAR(sum, b[i * columns + c], 1e-13) << n << ' ' << half;
          }
      }
}

TEST(Banded, ForwardHalfGivesTheQuadraticFormOfTheInverse) {
  trocar::core::Random random(3);
  for (int half : {3, 8}) {
    const int n = 30, first = 11;
    auto a = random_band(n, half, random);
    std::vector<double> b(n, 0.0);
    for (int i = first; i < n; ++i) b[i] = random.uniform(-1, 1);
    ASSERT_EQ(band_factor(n, half, a.data()), -1);
    std::vector<double> x = b, y = b;
    band_solve(n, half, a.data(), x.data());
    band_forward(n, half, a.data(), y.data(), 1, first);
    double expected = 0, form = 0;
    for (int i = 0; i < n; ++i) expected += b[i] * x[i];
    for (int i = first; i < n; ++i) form += y[i] * y[i] / a[band_at(half, i, i)];
    EXPECT_NEAR(form, expected, 1e-13);
  }
}

TEST(Banded, ReportsTheFirstPivotThatIsNotPositive) {
  trocar::core::Random random(2);
  auto a = random_band(10, 2, random);
  a[band_at(2, 6, 6)] = -1.0;
  EXPECT_EQ(band_factor(10, 2, a.data()), 6);
  a = random_band(10, 2, random);
  a[band_at(2, 3, 2)] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(band_factor(10, 2, a.data()), 3);
  std::vector<double> singular{1, -1, 1, 0};  // [[1,-1],[-1,1]]
  EXPECT_EQ(band_factor(2, 1, singular.data()), 1);
}

TEST(Banded, ClampedBeamBendsAsTheClosedFormSays) {
  // Fourth differences of w on a unit beam, w = w' = 0 at both ends, uniform load q: w(1/2) = q / 384. [Timoshenko]
  const int n = 999;
  const double h = 1.0 / (n + 1), s = 1.0 / (h * h * h * h);
  std::vector<double> a(band_size(n, 2), 0.0), w(n, 1.0);
  for (int i = 0; i < n; ++i) {
    a[band_at(2, i, i)] = (i == 0 || i == n - 1 ? 7 : 6) * s;
    if (i > 0) a[band_at(2, i, i - 1)] = -4 * s;
    if (i > 1) a[band_at(2, i, i - 2)] = s;
  }
  ASSERT_EQ(band_factor(n, 2, a.data()), -1);
  band_solve(n, 2, a.data(), w.data());
  EXPECT_NEAR(w[n / 2] * 384, 1.0, 1e-4);
}
