#include <cmath>

#include <gtest/gtest.h>

#include <trocar/collision/rods.hpp>
#include <trocar/core/random.hpp>

namespace trocar::collision {
namespace {

Vec3d anywhere(core::Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

TEST(Rods, NearestOnTheAxisIsNearerThanAnyOtherPointOfIt) {
  core::Random random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    const Capsule c{anywhere(random, 0.1), anywhere(random, 0.1), 0.002};
    const Vec3d p = anywhere(random, 0.2), q = nearest_on_axis(c, p);
    for (int k = 0; k <= 20; ++k) EXPECT_LE(length(p - q), length(p - (c.a + 0.05 * k * (c.b - c.a))) + 1e-12);
  }
}

TEST(Rods, ARodWithoutLengthIsABall) {
  const Capsule ball{{0.01, 0, 0}, {0.01, 0, 0}, 0.003};
  EXPECT_EQ(length(nearest_on_axis(ball, {0.5, 0.1, 0}) - ball.a), 0.0);
  Vec3f side{};
  const RodContact c = touch(ball, {{0.01, 0.004, 0}, {0.01, 0.004, 0}, 0.002}, side);
  EXPECT_NEAR(c.depth, 0.001, 1e-12);
  EXPECT_NEAR(c.normal.y, 1, 1e-12);
}

TEST(Rods, CrossedRodsTouchByTheSumOfTheirRadii) {
  // One along x, one along y, 3.5 mm above it; radii 2.5 and 1.5: half a millimetre too near.
  Vec3f side{};
  const RodContact c =
      touch({{-0.05, 0, 0}, {0.05, 0, 0}, 0.0025}, {{0.02, -0.01, 0.0035}, {0.02, 0.03, 0.0035}, 0.0015}, side);
  EXPECT_NEAR(c.depth, 0.0005, 1e-12);
  EXPECT_NEAR(c.s, 0.7, 1e-12);
  EXPECT_NEAR(c.t, 0.25, 1e-12);
  EXPECT_NEAR(length(c.normal - Vec3d{0, 0, 1}), 0, 1e-12);
  EXPECT_NEAR(side.z, 1, 1e-6);
}

TEST(Rods, ApartTheyForgetTheirSide) {
  Vec3f side{0, 0, 1};
  const double gap = 0.004 + kRemember + 1e-5;
  const RodContact c = touch({{-0.05, 0, 0}, {0.05, 0, 0}, 0.0025}, {{0, -0.01, gap}, {0, 0.01, gap}, 0.0015}, side);
  EXPECT_LT(c.depth, 0);
  EXPECT_EQ(side.z, 0.0f);
}

TEST(Rods, ParallelRodsTouchEverywhereAlongTheirOverlap) {
  Vec3f side{};
  const RodContact c = touch({{0, 0, 0}, {0.04, 0, 0}, 0.002}, {{0.01, 0.003, 0}, {0.03, 0.003, 0}, 0.002}, side);
  EXPECT_NEAR(c.depth, 0.001, 1e-12);
  EXPECT_NEAR(c.normal.y, 1, 1e-12);
}

TEST(Rods, AfterCrossingTheContactPointsBackToTheOldSide) {
  // The second rod sinks through the first in steps of 1 mm, as fast as hands move in a tick and a half.
  Vec3f side{};
  const Capsule fixed{{-0.05, 0, 0}, {0.05, 0, 0}, 0.0025};
  for (double z = 0.005; z > -0.0061; z -= 0.001) {
    const RodContact c = touch(fixed, {{0, -0.01, z}, {0, 0.01, z}, 0.0015}, side);
    if (std::fabs(z) > 1e-9) {
      EXPECT_NEAR(c.normal.z, 1, 1e-9) << "at " << z;
    }
    EXPECT_NEAR(c.depth, 0.004 - z, 1e-9) << "as deep as it takes to go back, at " << z;
  }
}

TEST(Rods, SweptAcrossAtHandSpeedNothingPassesWhateverTheAngle) {
  // A rod swept at 0.6 m/s (0.6 mm a tick) across another that gives way at once: it is always put back to its side.
  core::Random random(2);
  for (int trial = 0; trial < 500; ++trial) {
    const Vec3d along = normalised(anywhere(random, 1));
    const Vec3d across = normalised(cross(along, any_perpendicular(along)));
    const double angle = random.uniform(0.05, 3.09);
    const Vec3d other = std::cos(angle) * along + std::sin(angle) * any_perpendicular(along);
    Capsule moving{-0.03 * along, 0.03 * along, random.uniform(0.0009, 0.005)};
    Capsule element{-0.0013 * other, 0.0013 * other, random.uniform(0.0012, 0.004)};
    const Vec3d from = (moving.radius + element.radius + 0.001) * across;
    moving.a -= from;
    moving.b -= from;
    Vec3f side{};
    for (int tick = 0; tick < 60; ++tick) {
      moving.a += 0.0006 * across;
      moving.b += 0.0006 * across;
      const RodContact c = touch(moving, element, side);
      if (c.depth <= 0) continue;
      element.a += c.depth * c.normal;
      element.b += c.depth * c.normal;
    }
    EXPECT_GT(dot(element.a - moving.a, across), 0) << "trial " << trial;
  }
}

TEST(Rods, PassesWithinMeansNearerThanTheRadius) {
  core::Random random(3);
  int within = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3d a = anywhere(random, 0.02), b = anywhere(random, 0.02), c = anywhere(random, 0.02),
                d = anywhere(random, 0.02);
    double least = 1;
    for (int i = 0; i <= 100; ++i) {
      const Vec3d p = a + 0.01 * i * (b - a);
      least = std::min(least, length(p - nearest_on_axis({c, d, 0}, p)));
    }
    const bool claimed = passes_within(a, b, c, d, 0.005);
    within += claimed;
    if (std::fabs(least - 0.005) > 3e-4) {
      EXPECT_EQ(claimed, least < 0.005);
    }
  }
  EXPECT_GT(within, 100);
  EXPECT_LT(within, 1900);
}

TEST(PushOut, OutsideItIsStraightAwayFromTheAxis) {
  // A shaft 1 mm above the surface point, radius 2.5 mm: the point must go down by 1.5 mm.
  const Push p = push_out({{-0.05, 0, 0.001}, {0.05, 0, 0.001}, 0.0025}, {0, 0, 0}, {0, 0, 1}, 0.006);
  EXPECT_NEAR(p.depth, 0.0015, 1e-12);
  EXPECT_NEAR(p.direction.z, -1, 1e-12);
}

TEST(PushOut, BehindTheSurfaceItIsInwardsUntilTheAxisIsOutside) {
  // The axis is 2 mm below the surface point: not out at the far side, but back by 2 + 2.5 mm.
  const Push p = push_out({{-0.05, 0, -0.002}, {0.05, 0, -0.002}, 0.0025}, {0, 0, 0}, {0, 0, 1}, 0.006);
  EXPECT_NEAR(p.depth, 0.0045, 1e-12);
  EXPECT_NEAR(p.direction.z, -1, 1e-12);
}

TEST(PushOut, TooDeepOrBesideItIsNotThisSurface) {
  EXPECT_EQ(push_out({{-0.05, 0, -0.007}, {0.05, 0, -0.007}, 0.0025}, {0, 0, 0}, {0, 0, 1}, 0.006).depth, 0);
  EXPECT_EQ(push_out({{-0.05, 0.003, -0.002}, {0.05, 0.003, -0.002}, 0.0025}, {0, 0, 0}, {0, 0, 1}, 0.006).depth, 0);
  EXPECT_EQ(push_out({{-0.05, 0, 0.003}, {0.05, 0, 0.003}, 0.0025}, {0, 0, 0}, {0, 0, 1}, 0.006).depth, 0);
}

TEST(PushOut, AfterwardsThePointIsARadiusAwayFromWhereTheAxisWasNearestAndNotInFrontOfIt) {
  core::Random random(4);
  int pushed = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3d n = normalised(anywhere(random, 1));
    const Capsule rod{anywhere(random, 0.05), anywhere(random, 0.05), 0.0025};
    const Vec3d p = rod.a + random.uniform(0.2, 0.8) * (rod.b - rod.a) + anywhere(random, 0.003);
    const Push push = push_out(rod, p, n, 0.006);
    if (push.depth <= 0) continue;
    ++pushed;
    const Vec3d nearest = nearest_on_axis(rod, p), after = p + push.depth * push.direction;
    EXPECT_GE(length(after - nearest), rod.radius - 1e-9) << "trial " << trial;
    EXPECT_LE(dot(after - nearest, n), 1e-9) << "trial " << trial;
  }
  EXPECT_GT(pushed, 500);
}

}  // namespace
}  // namespace trocar::collision
