#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/numerics/dense_lu.hpp>
#include <trocar/numerics/symmetric3.hpp>

using namespace trocar;
using numerics::DenseLu;

TEST(DenseLu, SolvesWhatItMultipliesHoweverManyColumns) {
  core::Random random(1);
  for (int n : {1, 2, 5, 40}) {
    std::vector<double> a, x, b(3 * static_cast<std::size_t>(n), 0.0);
    for (int i = 0; i < n * n; ++i) a.push_back(random.uniform(-1, 1));
    for (int i = 0; i < 3 * n; ++i) x.push_back(random.uniform(-1, 1));
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int c = 0; c < 3; ++c) b[3 * i + c] += a[i * n + j] * x[3 * j + c];
    const DenseLu lu(n, a);
    ASSERT_FALSE(lu.singular());
    lu.solve(b.data(), 3);
    for (int i = 0; i < 3 * n; ++i) ASSERT_NEAR(b[i], x[i], 1e-10) << n;
  }
}

TEST(DenseLu, ChangesRowsWhereAPivotIsNothing) {
  const DenseLu lu(2, {0, 1, 1, 0});
  ASSERT_FALSE(lu.singular());
  double x[2] = {3, 4};
  lu.solve(x);
  EXPECT_EQ(x[0], 4);
  EXPECT_EQ(x[1], 3);
}

TEST(DenseLu, SaysWhatIsSingular) {
  EXPECT_TRUE(DenseLu(2, {1, 2, 2, 4}).singular());
  EXPECT_TRUE(DenseLu(3, std::vector<double>(9, 0.0)).singular());
  EXPECT_TRUE(DenseLu(1, {std::nan("")}).singular());
}

TEST(Principal, AxesAreThoseOfAnEllipsoidOfPoints) {
  const Vec3d x = normalised(Vec3d{1, 2, 2}), y = normalised(Vec3d{-2, -1, 2}), z = cross(x, y);
  const Mat3d a = 5.0 * outer(y, y) + 3.0 * outer(x, x) + 0.25 * outer(z, z);
  const numerics::Principal p = numerics::principal(a);
  EXPECT_NEAR(p.value[0], 5, 1e-14);
  EXPECT_NEAR(p.value[1], 3, 1e-14);
  EXPECT_NEAR(p.value[2], 0.25, 1e-14);
  EXPECT_NEAR(std::fabs(dot(p.axis[0], y)), 1, 1e-14);
  EXPECT_NEAR(std::fabs(dot(p.axis[1], x)), 1, 1e-14);
  EXPECT_NEAR(dot(cross(p.axis[0], p.axis[1]), p.axis[2]), 1, 1e-14) << "right-handed";
  for (int k = 0; k < 3; ++k) EXPECT_LT(length(a * p.axis[k] - p.value[k] * p.axis[k]), 1e-14);
  const numerics::Principal same = numerics::principal(Mat3d::identity());
  EXPECT_EQ(same.axis[0], (Vec3d{1, 0, 0}));
}

TEST(Principal, CovarianceIsAboutTheMean) {
  Vec3d mean;
  const std::vector<Vec3d> points{{1, 2, 3}, {3, 2, 3}, {2, 5, 3}, {2, -1, 3}};
  const Mat3d c = numerics::covariance(points, mean);
  EXPECT_EQ(mean, (Vec3d{2, 2, 3}));
  EXPECT_DOUBLE_EQ(c.m[0][0], 0.5);
  EXPECT_DOUBLE_EQ(c.m[1][1], 4.5);
  EXPECT_DOUBLE_EQ(c.m[0][1], 0.0);
  EXPECT_DOUBLE_EQ(c.m[2][2], 0.0);
}
