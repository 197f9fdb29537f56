#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/numerics/pivoted_qr.hpp>
#include <trocar/numerics/singular_values.hpp>

namespace trocar::numerics {
namespace {

using Matrix = std::vector<double>;  // column by column

/// m x n of rank r: products of random columns and rows.
Matrix of_rank(int m, int n, int r, core::Random& random) {
  Matrix a(std::size_t(m * n), 0.0), left(std::size_t(m * r)), right(std::size_t(r * n));
  for (double& x : left) x = random.uniform(-1, 1);
  for (double& x : right) x = random.uniform(-1, 1);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < m; ++i)
      for (int k = 0; k < r; ++k)
        a[std::size_t(j * m + i)] += left[std::size_t(k * m + i)] * right[std::size_t(j * r + k)];
  return a;
}
std::vector<double> times(const Matrix& a, int m, int n, const std::vector<double>& x) {
  std::vector<double> y(std::size_t(m), 0.0);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < m; ++i) y[std::size_t(i)] += a[std::size_t(j * m + i)] * x[std::size_t(j)];
  return y;
}
double largest(const std::vector<double>& v) {
  double most = 0;
  for (const double x : v) most = std::max(most, std::fabs(x));
  return most;
}

struct Size {
  int m, n, r;
};
const Size kSizes[] = {{1, 1, 1}, {5, 2, 2}, {6, 6, 6},   {6, 6, 5}, {3, 7, 3},
                       {3, 7, 2}, {9, 4, 2}, {12, 12, 7}, {4, 4, 0}};

TEST(PivotedQr, FindsTheRankOfAnyShape) {
  core::Random random(1);
  for (const Size& s : kSizes) {
    const Matrix a = of_rank(s.m, s.n, s.r, random);
    PivotedQr qr(12, 12);
    std::copy(a.begin(), a.end(), qr.matrix(s.m, s.n));
    EXPECT_EQ(qr.factor(1e-10, 1e-13), s.r) << s.m << " x " << s.n;
  }
}

TEST(PivotedQr, SolutionsAreLeastSquaresAndTheShortest) {
  core::Random random(2);
  for (const Size& s : kSizes) {
    const Matrix a = of_rank(s.m, s.n, s.r, random);
    PivotedQr qr(12, 12);
    std::copy(a.begin(), a.end(), qr.matrix(s.m, s.n));
    qr.factor(1e-10, 1e-13);
    std::vector<double> b(std::size_t(s.m)), x(std::size_t(s.n));
    for (double& v : b) v = random.uniform(-1, 1);
    qr.solve(b.data(), x.data());
    std::vector<double> r = times(a, s.m, s.n, x);
    for (std::size_t i = 0; i < r.size(); ++i) r[i] -= b[i];
    for (int j = 0; j < s.n; ++j) {  // the residual is square to every column
      double sum = 0;
      for (int i = 0; i < s.m; ++i) sum += a[std::size_t(j * s.m + i)] * r[std::size_t(i)];
      EXPECT_NEAR(sum, 0, 1e-12);
    }
    for (int k = 0; k < s.n - s.r; ++k) {  // and the solution to all that the matrix takes to nothing
      std::vector<double> z(std::size_t(s.n));
      qr.null_vector(k, z.data());
      EXPECT_LT(largest(times(a, s.m, s.n, z)), 1e-13);
      double along = 0, size = 0;
      for (std::size_t j = 0; j < z.size(); ++j) along += z[j] * x[j], size += z[j] * z[j];
      EXPECT_NEAR(along, 0, 1e-12);
      EXPECT_NEAR(size, 1, 1e-13);
    }
  }
}

TEST(PivotedQr, PivotsFallAndBoundTheSingularValues) {
  core::Random random(3);
  for (int round = 0; round < 20; ++round) {
    Matrix a = of_rank(8, 6, 6, random);
    PivotedQr qr(8, 6);
    std::copy(a.begin(), a.end(), qr.matrix(8, 6));
    qr.factor(1e-12);
    double values[6];
    singular_values(8, 6, a.data(), values);
    for (int k = 1; k < 6; ++k) EXPECT_LE(qr.pivot(k), qr.pivot(k - 1) * (1 + 1e-12));
    EXPECT_GE(qr.pivot(5) * (1 + 1e-12), values[5]);
    EXPECT_LE(qr.pivot(0), values[0] * (1 + 1e-12));
  }
}

TEST(SingularValues, AreThoseOfAMatrixWhoseOnesAreKnown) {
  // [Hilbert-like] products of turns with a known diagonal, down to 1e-9 of the largest
  const double wanted[] = {3, 0.5, 1e-4, 3e-9};
  core::Random random(4);
  Matrix a(16, 0.0);
  for (int i = 0; i < 4; ++i) a[std::size_t(5 * i)] = wanted[i];
  for (int round = 0; round < 30; ++round) {
    const int p = int(random.next() % 4), q = (p + 1 + int(random.next() % 3)) % 4;
    const double c = random.uniform(-1, 1), s = std::sqrt(1 - c * c);
    for (int j = 0; j < 4; ++j) {  // rows p, q
      const double x = a[std::size_t(4 * j + p)], y = a[std::size_t(4 * j + q)];
      a[std::size_t(4 * j + p)] = c * x - s * y;
      a[std::size_t(4 * j + q)] = s * x + c * y;
    }
  }
  double values[4];
  singular_values(4, 4, a.data(), values);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(values[i], wanted[i], 1e-14);
}

TEST(Determinant, IsThatOfAPermutedTriangle) {
  Matrix a{0, 0, 2, 0, 3, 1, 5, 7, 4};  // columns (0 0 2), (0 3 1), (5 7 4)
  EXPECT_DOUBLE_EQ(determinant(3, a.data()), -30);
  Matrix none{1, 2, 2, 4};
  EXPECT_DOUBLE_EQ(determinant(2, none.data()), 0);
}

}  // namespace
}  // namespace trocar::numerics
