#include <vector>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/numerics/conjugate_gradient.hpp>

using namespace trocar;
using namespace trocar::numerics;

namespace {

// A = G G^T + shift, with badly scaled rows: dense, symmetric, positive definite for shift > 0.
struct Dense {
  int n;
  std::vector<double> a;
  void operator()(const double* x, double* y) const {
    for (int i = 0; i < n; ++i) {
      y[i] = 0;
      for (int j = 0; j < n; ++j) y[i] += a[i * n + j] * x[j];
    }
  }
};
Dense badly_scaled(int n) {
  core::Random random(3);
  std::vector<double> g(n * n), scale(n);
  for (double& value : g) value = random.uniform(-1, 1);
  for (int i = 0; i < n; ++i) scale[i] = (i / 3) % 2 ? 100.0 : 1.0;
  Dense result{n, std::vector<double>(n * n, 0.0)};
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      double sum = i == j ? 3.0 : 0.0;
      for (int k = 0; k < n; ++k) sum += g[i * n + k] * g[j * n + k];
      result.a[i * n + j] = scale[i] * scale[j] * sum;
    }
  return result;
}
std::vector<double> diagonal_of(const Dense& m) {
  std::vector<double> d(m.n);
  for (int i = 0; i < m.n; ++i) d[i] = m.a[i * m.n + i];
  return d;
}
std::vector<Mat3d> inverse_blocks_of(const Dense& m) {
  std::vector<Mat3d> blocks(m.n / 3);
  for (int b = 0; b < m.n / 3; ++b) {
    Mat3d block;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) block.m[i][j] = m.a[(3 * b + i) * m.n + 3 * b + j];
    blocks[b] = inverse(block);
  }
  return blocks;
}

}  // namespace

TEST(ConjugateGradient, FindsTheKnownSolutionWithEveryPreconditioner) {
  const int n = 30;
  const Dense matrix = badly_scaled(n);
  std::vector<double> truth(n), b(n);
  for (int i = 0; i < n; ++i) truth[i] = i % 7 - 3.0;
  matrix(truth.data(), b.data());
  const auto diagonal = diagonal_of(matrix);
  const auto blocks = inverse_blocks_of(matrix);
  ConjugateGradientWork work(n);
  const auto solve = [&](const auto& preconditioner) {
    std::vector<double> x(n, 0.0);
    const auto done = conjugate_gradient(matrix, preconditioner, b.data(), x.data(), n, {2000, 1e-13}, work);
    EXPECT_TRUE(done.converged);
    EXPECT_LE(done.relative_residual, 1e-13);
    for (int i = 0; i < n; ++i) EXPECT_NEAR(x[i], truth[i], 1e-7);
    return done.iterations;
  };
  const int plain = solve(NoPreconditioner{}), scaled = solve(DiagonalPreconditioner{diagonal.data()});
  const int blocked = solve(BlockPreconditioner{blocks.data()});
  EXPECT_LT(scaled, plain);
  EXPECT_LT(blocked, plain);
}

TEST(ConjugateGradient, EndsInAsManyStepsAsThereAreDistinctEigenvalues) {
  const int n = 100;
  const auto apply = [](const double* x, double* y) {
    for (int i = 0; i < n; ++i) y[i] = (1 + i % 4) * x[i];
  };
  std::vector<double> b(n), x(n, 0.0);
  for (int i = 0; i < n; ++i) b[i] = 1.0 + i;
  ConjugateGradientWork work(n);
  const auto done = conjugate_gradient(apply, NoPreconditioner{}, b.data(), x.data(), n, {}, work);
  EXPECT_TRUE(done.converged);
  EXPECT_LE(done.iterations, 4);
}

TEST(ConjugateGradient, TellsAnIndefiniteMatrixAndAnExhaustedBudget) {
  const int n = 6;
  const auto indefinite = [](const double* x, double* y) {
    for (int i = 0; i < n; ++i) y[i] = i == 2 ? -x[i] : x[i];
  };
  std::vector<double> b{0, 0, 1, 0, 0, 0}, x(n, 0.0);
  ConjugateGradientWork work(n);
  const auto bad = conjugate_gradient(indefinite, NoPreconditioner{}, b.data(), x.data(), n, {}, work);
  EXPECT_TRUE(bad.not_positive);
  EXPECT_FALSE(bad.converged);
  const Dense matrix = badly_scaled(30);
  std::vector<double> ones(30, 1.0), y(30, 0.0);
  work.resize(30);
  const auto stopped = conjugate_gradient(matrix, NoPreconditioner{}, ones.data(), y.data(), 30, {3, 1e-12}, work);
  EXPECT_EQ(stopped.iterations, 3);
  EXPECT_FALSE(stopped.converged);
}

TEST(ConjugateGradient, ZeroRightHandSideHasTheZeroSolution) {
  const Dense matrix = badly_scaled(6);
  std::vector<double> zero(6, 0.0), x(6, 5.0);
  ConjugateGradientWork work(6);
  EXPECT_TRUE(conjugate_gradient(matrix, NoPreconditioner{}, zero.data(), x.data(), 6, {}, work).converged);
  EXPECT_EQ(x, zero);
}

TEST(Mat3, InverseTimesMatrixIsTheIdentity) {
  core::Random random(5);
  for (int t = 0; t < 200; ++t) {
    Mat3d a;
    for (auto& row : a.m)
      for (double& value : row) value = random.uniform(-1, 1);
    if (std::fabs(determinant(a)) < 0.01) continue;
    const Mat3d product = inverse(a) * a;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(product.m[i][j], i == j, 1e-12);
  }
}
