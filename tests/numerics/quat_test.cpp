#include <vector>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/numerics/quat.hpp>

using namespace trocar;

namespace {

Vec3d random_vector(core::Random& random) {
  const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
  return {x, y, z};
}
Quatd random_rotation(core::Random& random) {
  const Vec3d axis = random_vector(random);
  return quat_from_axis_angle(axis, random.uniform(-3.1, 3.1));
}

}  // namespace

TEST(Quat, QuarterTurnAboutZTakesXToY) {
  const Vec3d y = rotate(quat_from_axis_angle(Vec3d{0, 0, 3}, portable::pi / 2), Vec3d{1, 0, 0});
  EXPECT_LT(length(y - Vec3d{0, 1, 0}), 1e-15);
}

TEST(Quat, ProductTurnsByTheRightFactorFirst) {
  core::Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Quatd a = random_rotation(random), b = random_rotation(random);
    const Vec3d v = random_vector(random);
    EXPECT_LT(length(rotate(a * b, v) - rotate(a, rotate(b, v))), 2e-15);
    EXPECT_LT(length(rotate(conjugate(a), rotate(a, v)) - v), 2e-15);
  }
}

TEST(Quat, MatrixAndQuaternionTurnAlikeAndConvertBothWays) {
  core::Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Quatd q = random_rotation(random);
    const Vec3d v = random_vector(random);
    EXPECT_LT(length(rotate(q, v) - to_mat3(q) * v), 2e-15);
    const Quatd back = quat_from_mat3(to_mat3(q));
    EXPECT_GT(std::fabs(dot(q, back)), 1 - 1e-14);
    EXPECT_GE(back.w, 0.0);
  }
  for (Vec3d axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {  // half turns: w = 0
    const Quatd q = quat_from_axis_angle(axis, portable::pi);
    EXPECT_GT(std::fabs(dot(q, quat_from_mat3(to_mat3(q)))), 1 - 1e-14);
  }
}

TEST(Quat, TurnBetweenTwoVectorsIsTheShortestOne) {
  core::Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d a = random_vector(random), b = 5.0 * random_vector(random);
    const Quatd q = quat_from_two_vectors(a, b);
    EXPECT_LT(length(rotate(q, normalised(a)) - normalised(b)), 1e-13);  // the sum of nearly opposite ones loses digits
    EXPECT_LT(std::fabs(dot(q.vector(), a)), 1e-14);
  }
  const Vec3d a{0.6, 0, 0.8};
  EXPECT_LT(length(rotate(quat_from_two_vectors(a, -a), a) + a), 1e-14);
  EXPECT_LT(length(rotate(quat_from_two_vectors(a, a), a) - a), 1e-15);
}

TEST(Quat, RotationVectorIsTheInverseOfItsQuaternion) {
  core::Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d r = 1.8 * random_vector(random);
    if (length(r) > 3.14) continue;
    EXPECT_LT(length(rotation_vector(quat_from_rotation_vector(r)) - r), 1e-14);
  }
  EXPECT_EQ(rotation_vector(Quatd{}), Vec3d{});
  EXPECT_EQ(quat_from_rotation_vector(Vec3d{}), Quatd{});
}

TEST(Quat, SlerpTurnsAtConstantSpeedTheShortWay) {
  const Vec3d axis{1, 2, 3};
  for (double angle : {0.001, 0.5, 3.0}) {
    const Quatd a = quat_from_axis_angle(axis, 0.2), b = quat_from_axis_angle(axis, 0.2 + angle);
    for (double t : {0.0, 0.25, 0.5, 1.0}) {
      const Quatd truth = quat_from_axis_angle(axis, 0.2 + t * angle);
      EXPECT_GT(dot(slerp(a, b, t), truth), 1 - 1e-13);
      EXPECT_GT(std::fabs(dot(slerp(a, -b, t), truth)), 1 - 1e-13);
    }
  }
}

TEST(Quat, FloatsTurnToo) {
  const Quatf q = quat_from_axis_angle(Vec3f{0, 0, 1}, 1.57079633f);
  EXPECT_LT(length(rotate(q, Vec3f{1, 0, 0}) - Vec3f{0, 1, 0}), 1e-6f);
}
