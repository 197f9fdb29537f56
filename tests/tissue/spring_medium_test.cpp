#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/tissue/network/spring_medium.hpp>

namespace trocar::tissue {
namespace {

constexpr double kE = 20e3;

TEST(SpringMedium, WithoutFibresItIsTheSolidOfPoissonsRatioOneQuarter) {
  const SpringMedium m = spring_medium(kE);
  const Symmetric s = stress(m, {1e-3, -0.25e-3, -0.25e-3, 0, 0, 0});
  EXPECT_NEAR(s.xx, kE * 1e-3, 1e-9 * kE * 1e-3);
  EXPECT_NEAR(s.yy, 0, 1e-12 * kE);
  EXPECT_NEAR(stress(m, {0, 0, 0, 0, 0, 1e-3}).xy, 2 * 0.4 * kE * 1e-3, 1e-9 * kE) << "G = 0.4 E";
  for (const Vec3d n : {Vec3d{1, 0, 0}, normalised(Vec3d{1, 2, 3})}) EXPECT_NEAR(youngs_modulus(m, n), kE, 1e-8 * kE);
}

TEST(SpringMedium, FibresMakeItAsMuchStifferAlongThemAsAsked) {
  core::Random random(5);
  for (const double ratio : {0.6, 1.5, 2.0, 4.0}) {
    const Vec3d f = normalised(Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
    const SpringMedium m = spring_medium(kE, 3 * f, ratio);
    const Vec3d across = normalised(cross(f, Vec3d{0.3, -0.5, 0.8}));
    EXPECT_NEAR(youngs_modulus(m, f), ratio * kE, 1e-6 * kE) << ratio;
    EXPECT_NEAR(youngs_modulus(m, across), kE, 1e-6 * kE) << ratio;
    EXPECT_NEAR(youngs_modulus(m, normalised(cross(f, across))), kE, 1e-6 * kE) << ratio;
  }
}

TEST(SpringMedium, ItsStressIsThatOfASampleOfSprings) {
  // Many springs in random directions, weighted by the density: their sum is the medium's stress.
  const SpringMedium m = spring_medium(kE, {0, 1, 1}, 2);
  const Symmetric e{1e-3, -2e-3, 0.5e-3, 0.3e-3, -0.4e-3, 0.8e-3};
  core::Random random(9);
  Symmetric sum;
  const int count = 400000;
  for (int i = 0; i < count; ++i) {
    Vec3d n;
    do n = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    while (dot(n, n) > 1 || dot(n, n) < 1e-4);
    n = normalised(n);
    const double t = m.s * m.density(n) * dot(n, e * n) / count;
    sum.xx += t * n.x * n.x, sum.yy += t * n.y * n.y, sum.zz += t * n.z * n.z;
    sum.yz += t * n.y * n.z, sum.xz += t * n.x * n.z, sum.xy += t * n.x * n.y;
  }
  const Symmetric s = stress(m, e);
  const double scale = 0.01 * kE * 2e-3;
  EXPECT_NEAR(sum.xx, s.xx, scale);
  EXPECT_NEAR(sum.yy, s.yy, scale);
  EXPECT_NEAR(sum.zz, s.zz, scale);
  EXPECT_NEAR(sum.yz, s.yz, scale);
  EXPECT_NEAR(sum.xz, s.xz, scale);
  EXPECT_NEAR(sum.xy, s.xy, scale);
}

TEST(SpringMedium, RefusesWhatSpringsCannotBe) {
  EXPECT_THROW(spring_medium(0), std::invalid_argument);
  EXPECT_THROW(spring_medium(kE, {1, 0, 0}, 5), std::invalid_argument);
  EXPECT_THROW(spring_medium(kE, {1, 0, 0}, 0.1), std::invalid_argument);
}

}  // namespace
}  // namespace trocar::tissue
