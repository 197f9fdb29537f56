// Every claim is held against brute force: many points sampled on both bodies can come close to, never below, what the
// functions call closest.
#include <array>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/geometry/surfaces/nearest.hpp>

using namespace trocar;
using namespace trocar::geometry;

namespace {

Vec3d random_point(core::Random& random) {
  const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
  return {x, y, z};
}

// Some general, some with repeated corners, some with all corners on a line, some needles.
std::array<Vec3d, 3> random_triangle(core::Random& random, int kind) {
  const Vec3d a = random_point(random), b = random_point(random), c = random_point(random);
  switch (kind % 6) {
    case 1:
      return {a, a, b};
    case 2:
      return {a, b, a};
    case 3:
      return {a, a, a};
    case 4:
      return {a, b, a + random.uniform(-1, 2) * (b - a)};
    case 5:
      return {a, b, b + 1e-7 * c};
    default:
      return {a, b, c};
  }
}

constexpr int kSteps = 60;

double sampled_point_triangle(Vec3d p, const std::array<Vec3d, 3>& t) {
  double best = std::numeric_limits<double>::max();
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; i + j <= kSteps; ++j) {
      const double u = double(i) / kSteps, v = double(j) / kSteps;
      best = std::min(best, distance2(p, t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0])));
    }
  return std::sqrt(best);
}
double sampled_segment_segment(Vec3d p0, Vec3d p1, Vec3d q0, Vec3d q1) {
  double best = std::numeric_limits<double>::max();
  for (int i = 0; i <= kSteps; ++i) {
    const Vec3d p = p0 + (double(i) / kSteps) * (p1 - p0);
    for (int j = 0; j <= kSteps; ++j) best = std::min(best, distance2(p, q0 + (double(j) / kSteps) * (q1 - q0)));
  }
  return std::sqrt(best);
}
// The distance along the segment is convex, so golden section on it with the exact point-triangle distance will do.
double searched_segment_triangle(Vec3d p0, Vec3d p1, const std::array<Vec3d, 3>& t) {
  double low = 0.0, high = 1.0;
  const auto at = [&](double s) { return closest_on_triangle(p0 + s * (p1 - p0), t[0], t[1], t[2]).distance2; };
  for (int i = 0; i < 200; ++i) {
    const double first = low + (high - low) * 0.382, second = low + (high - low) * 0.618;
    (at(first) <= at(second) ? high : low) = at(first) <= at(second) ? second : first;
  }
  return std::sqrt(at(0.5 * (low + high)));
}
constexpr double kCoarse = 3.5 / kSteps;  // what sampling may miss

template <class T>
Vec3<T> at(const std::array<Vec3<T>, 3>& t, Vec3<T> w) {
  return w.x * t[0] + w.y * t[1] + w.z * t[2];
}

}  // namespace

TEST(Nearest, PointOnTriangleIsAsCloseAsAnySampledPointOfIt) {
  core::Random random(11);
  for (int i = 0; i < 1200; ++i) {
    const auto t = random_triangle(random, i);
    const Vec3d p = 1.5 * random_point(random);
    const auto found = closest_on_triangle(p, t[0], t[1], t[2]);
    const double sampled = sampled_point_triangle(p, t), mine = std::sqrt(found.distance2);
    ASSERT_LE(mine, sampled + 1e-9) << i;
    ASSERT_GE(mine, sampled - kCoarse) << i;
    ASSERT_LT(length(at(t, found.weights) - found.point), 1e-9) << i;
    for (int k = 0; k < 3; ++k) ASSERT_GE(found.weights[k], -1e-12) << i;
    ASSERT_NEAR(found.weights.x + found.weights.y + found.weights.z, 1.0, 1e-12);
  }
}

TEST(Nearest, SegmentsAreAsCloseAsAnySampledPair) {
  core::Random random(12);
  for (int i = 0; i < 1500; ++i) {
    const Vec3d p0 = random_point(random), q0 = random_point(random);
    Vec3d p1 = random_point(random), q1 = random_point(random);
    if (i % 5 == 1) q1 = q0 + random.uniform(-2, 2) * (p1 - p0);                                // parallel
    if (i % 5 == 2) p1 = p0;                                                                    // a point
    if (i % 5 == 3) q1 = q0, p1 = p0;                                                           // two points
    if (i % 5 == 4) q1 = q0 + random.uniform(-2, 2) * (p1 - p0) + 1e-8 * random_point(random);  // nearly parallel
    const auto found = closest_segments(p0, p1, q0, q1);
    const double sampled = sampled_segment_segment(p0, p1, q0, q1), mine = std::sqrt(found.distance2);
    ASSERT_LE(mine, sampled + 1e-9) << i;
    ASSERT_GE(mine, sampled - kCoarse) << i;
    ASSERT_TRUE(found.s >= 0 && found.s <= 1 && found.t >= 0 && found.t <= 1);
    ASSERT_LT(length(p0 + found.s * (p1 - p0) - found.on_first), 1e-14);
    ASSERT_LT(length(q0 + found.t * (q1 - q0) - found.on_second), 1e-14);
  }
}

TEST(Nearest, SegmentAndTriangleAreAsCloseAsASearchAlongTheSegmentFinds) {
  core::Random random(13);
  int crossings = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto t = random_triangle(random, i);
    const Vec3d p0 = random_point(random);
    const Vec3d p1 = i % 7 == 0 ? p0 : random_point(random);
    const auto found = closest_segment_triangle(p0, p1, t[0], t[1], t[2]);
    const double searched = searched_segment_triangle(p0, p1, t);
    ASSERT_NEAR(std::sqrt(found.distance2), searched, 2e-7) << i;
    ASSERT_LT(length(at(t, found.weights) - found.on_triangle), 1e-9) << i;
    ASSERT_LT(length(p0 + found.s * (p1 - p0) - found.on_segment), 1e-9) << i;
    crossings += found.distance2 == 0.0;
  }
  EXPECT_GT(crossings, 30);
}

TEST(Nearest, FloatAgreesWithDouble) {
  core::Random random(14);
  for (int i = 0; i < 3000; ++i) {
    const auto t = random_triangle(random, i);
    const Vec3d p0 = random_point(random), p1 = random_point(random);
    const auto single = closest_segment_triangle(vec_cast<float>(p0), vec_cast<float>(p1), vec_cast<float>(t[0]),
                                                 vec_cast<float>(t[1]), vec_cast<float>(t[2]));
    const auto exact = closest_segment_triangle(p0, p1, t[0], t[1], t[2]);
    ASSERT_NEAR(std::sqrt(single.distance2), std::sqrt(exact.distance2), 1e-4) << i;
  }
}

TEST(RayTriangle, HitsWhereTheRayPassesInsideAndNowhereElse) {
  core::Random random(15);
  for (int i = 0; i < 3000; ++i) {
    const std::array<Vec3d, 3> t{random_point(random), random_point(random), random_point(random)};
    const double u = random.uniform(-0.5, 1.5), v = random.uniform(-0.5, 1.5);
    if (std::min({std::fabs(u), std::fabs(v), std::fabs(1 - u - v)}) < 1e-6) continue;
    const Vec3d target = at(t, {1 - u - v, u, v}), origin = 3.0 * random_point(random);
    const auto hit = ray_triangle(origin, 0.5 * (target - origin), t[0], t[1], t[2]);
    ASSERT_EQ(hit.hit, u > 0 && v > 0 && u + v < 1) << i;
    if (!hit.hit) continue;
    EXPECT_NEAR(hit.t, 2.0, 1e-8);
    EXPECT_LT(length(hit.weights - Vec3d{1 - u - v, u, v}), 1e-6);
    EXPECT_FALSE(ray_triangle(origin, origin - target, t[0], t[1], t[2]).hit) << "behind";
  }
}

TEST(RayTriangle, NoRaySlipsBetweenNeighbours) {
  core::Random random(16);
  for (int i = 0; i < 20000; ++i) {  // a fan around a centre; rays through its inner edges, in float
    const Vec3f centre = vec_cast<float>(0.1 * random_point(random));
    const Vec3f ring[4] = {{1, 0.1f, 0}, {-0.2f, 1, 0.1f}, {-1, -0.1f, 0}, {0.1f, -1, -0.1f}};
    const Vec3f origin = vec_cast<float>(random_point(random)) + Vec3f{0, 0, 3};
    const Vec3f target = centre + float(random.uniform(0, 0.6)) * (ring[i % 4] - centre);
    int hits = 0;
    for (int k = 0; k < 4; ++k) hits += ray_triangle(origin, target - origin, centre, ring[k], ring[(k + 1) % 4]).hit;
    ASSERT_GE(hits, 1) << i;
  }
}

TEST(RayTriangle, DegenerateTrianglesAndRaysInThePlaneMiss) {
  const Vec3d a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
  EXPECT_FALSE(ray_triangle(Vec3d{-1, 0.2, 0}, Vec3d{1, 0, 0}, a, b, c).hit);
  EXPECT_FALSE(ray_triangle(Vec3d{0, 0, 1}, Vec3d{0, 0, -1}, a, a, a).hit);
  EXPECT_FALSE(ray_triangle(Vec3d{0.3, 0, 1}, Vec3d{0, 0, 0}, a, b, c).hit);
}

TEST(RayCapsule, FirstContactIsWhereTheDistanceFallsToTheRadius) {
  core::Random random(17);
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3d a = random_point(random), b = i % 4 ? random_point(random) : a;
    const Vec3d origin = 3.0 * random_point(random), direction = random_point(random) - origin;
    const double radius = random.uniform(0.05, 0.5);
    const auto distance_at = [&](double t) {
      const Vec3d p = origin + t * direction;
      return std::sqrt(distance2(p, a + closest_on_segment(p, a, b) * (b - a)));
    };
    const auto hit = ray_capsule(origin, direction, a, b, radius);
    double closest = 1e9;
    for (double t = 0; t < 3; t += 0.01) closest = std::min(closest, distance_at(t));
    if (!hit.hit) {
      ASSERT_GT(closest, radius - 1e-9) << i;
      continue;
    }
    ++hits;
    if (distance_at(0) <= radius) {
      ASSERT_EQ(hit.t, 0.0);
      continue;
    }
    ASSERT_NEAR(distance_at(hit.t), radius, 1e-7) << i;
    for (double s = 0; s < 0.99; s += 0.02) ASSERT_GT(distance_at(s * hit.t), radius - 1e-9) << i;
  }
  EXPECT_GT(hits, 300);
}
