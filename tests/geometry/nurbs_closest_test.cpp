#include <limits>

#include <trocar/geometry/nurbs/closest.hpp>
#include <trocar/geometry/nurbs/surface_edit.hpp>
#include <trocar/geometry/nurbs_shapes/curve_makers.hpp>
#include <trocar/geometry/nurbs_shapes/surface_makers.hpp>

#include "nurbs_cases.hpp"

using namespace trocar;
namespace nurbs = trocar::geometry::nurbs;
using nurbs::Curve;
using nurbs::Surface;

namespace {

double sampled_distance(const Curve& curve, Vec3d p) {
  double best = 1e9;
  for (double u : nurbs::over(curve.knots, 4001)) best = std::min(best, length(nurbs::point(curve, u) - p));
  return best;
}
double sampled_distance(const Surface& s, Vec3d p) {
  double best = 1e9;
  for (double v : nurbs::over(s.v, 121))
    for (double u : nurbs::over(s.u, 121)) best = std::min(best, length(nurbs::point(s, u, v) - p));
  return best;
}

}  // namespace

TEST(NurbsClosest, OnACurveIsAsNearAsAnySampleOfIt) {
  core::Random random(51);
  nurbs::each_curve(52, 1, 4, [&random](const Curve& curve) {
    const nurbs::ClosestOnCurve seeker(curve);
    for (int i = 0; i < 40; ++i) {
      const Vec3d p = 2.0 * nurbs::random_place(random) + Vec3d{random.uniform(-1, 6), 0, 0};
      const nurbs::CurveFoot foot = seeker.find(p);
      ASSERT_NEAR(foot.distance, length(foot.point - p), 1e-15);
      ASSERT_LT(length(foot.point - nurbs::point(curve, foot.u)), 1e-15);
      ASSERT_LE(foot.distance, sampled_distance(curve, p) + 1e-12) << i;
    }
  });
}

TEST(NurbsClosest, OnACurveIsFoundToRoundingWhereTheLineIsAtRightAngles) {
  const Curve ring = nurbs::circle({1, 2, 3}, {0, 0, 1}, 2);
  core::Random random(53);
  for (int i = 0; i < 200; ++i) {
    const Vec3d p = Vec3d{1, 2, 3} + 5.0 * nurbs::random_place(random);
    const Vec3d flat{p.x - 1, p.y - 2, 0};
    const nurbs::CurveFoot foot = nurbs::closest(ring, p);
    ASSERT_LT(length(foot.point - (Vec3d{1, 2, 3} + 2.0 * normalised(flat))), 1e-12) << i;
  }
}

TEST(NurbsClosest, BeyondAnEndItIsTheEndExactly) {
  core::Random random(54);
  const Curve curve = nurbs::random_curve(random, 3, false, true);
  const Vec3d out = nurbs::jet(curve, 4.0).first;
  const nurbs::CurveFoot end = nurbs::closest(curve, nurbs::point(curve, 4.0) + 0.05 * normalised(out));
  EXPECT_EQ(end.u, 4.0);
  const Vec3d in = nurbs::jet(curve, 1.0).first;
  EXPECT_EQ(nurbs::closest(curve, nurbs::point(curve, 1.0) - 0.05 * normalised(in)).u, 1.0);
  // A corner inside of a curve is a place like an end: the knot, to rounding.
  const Curve bend = nurbs::polyline(std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
  EXPECT_NEAR(nurbs::closest(bend, {2, -1, 0}).u, 0.5, 1e-14);
}

TEST(NurbsClosest, OfAPointOnItIsThatPoint) {
  nurbs::each_curve(55, 1, 4, [](const Curve& curve) {
    const nurbs::ClosestOnCurve seeker(curve);
    for (double u : nurbs::over(curve.knots, 61)) ASSERT_LT(seeker.find(nurbs::point(curve, u)).distance, 1e-13) << u;
  });
  core::Random random(56);
  for (int kind = 0; kind < 8; ++kind) {
    const Surface s = nurbs::random_surface(random, 3, 2, kind & 1, kind & 2, kind & 4);
    const nurbs::ClosestOnSurface seeker(s);
    for (double v : nurbs::over(s.v, 13))
      for (double u : nurbs::over(s.u, 13))
        ASSERT_LT(seeker.find(nurbs::point(s, u, v)).distance, 1e-12) << kind << ' ' << u << ' ' << v;
  }
}

TEST(NurbsClosest, OnASurfaceIsAsNearAsAnySampleOfIt) {
  core::Random random(57);
  for (int kind = 0; kind < 8; ++kind)
    for (int degree = 1; degree <= 3; ++degree) {
      const Surface s = nurbs::random_surface(random, degree, 4 - degree, kind & 1, kind & 2, kind & 4);
      const nurbs::ClosestOnSurface seeker(s);
      for (int i = 0; i < 6; ++i) {
        const Vec3d p = nurbs::random_place(random) + Vec3d{random.uniform(0, 5), random.uniform(0, 5), 0};
        const nurbs::SurfaceFoot foot = seeker.find(p);
        ASSERT_NEAR(foot.distance, length(nurbs::point(s, foot.u, foot.v) - p), 1e-14);
        ASSERT_LE(foot.distance, sampled_distance(s, p) + 1e-9) << kind << ' ' << degree << ' ' << i;
      }
    }
}

TEST(NurbsClosest, OnSphereAndTorusItIsTheFormulas) {
  core::Random random(58);
  const Surface ball = nurbs::sphere({1, 2, 3}, 2), ring = nurbs::torus({1, 2, 3}, {0, 0, 1}, 2, 0.5);
  const nurbs::ClosestOnSurface on_ball(ball), on_ring(ring);
  for (int i = 0; i < 300; ++i) {
    const Vec3d d = 4.0 * nurbs::random_place(random), p = Vec3d{1, 2, 3} + d;
    const nurbs::SurfaceFoot foot = on_ball.find(p);
    ASSERT_NEAR(foot.distance, std::fabs(length(d) - 2), 1e-12) << i;
    ASSERT_LT(length(foot.point - (Vec3d{1, 2, 3} + 2.0 * normalised(d))), 1e-10) << i;
    const Vec3d middle = 2.0 * normalised(Vec3d{d.x, d.y, 0});
    ASSERT_NEAR(on_ring.find(p).distance, std::fabs(length(d - middle) - 0.5), 1e-12) << i;
  }
}

TEST(NurbsClosest, PassesOverAPole) {
  const Surface ball = nurbs::sphere({0, 0, 0}, 1);
  core::Random random(59);
  for (int i = 0; i < 100; ++i) {
    // From one side of the pole to a point beyond it.
    const double u = random.uniform(), t = random.uniform(0.02, 0.3), a = portable::two_pi * random.uniform();
    const Vec3d p = 1.3 * normalised(Vec3d{t * portable::cos(a), t * portable::sin(a), -1});
    const nurbs::SurfaceFoot foot = nurbs::closest_from(ball, p, u, 0.05);
    ASSERT_NEAR(foot.distance, 0.3, 1e-12) << i << ' ' << u;
  }
  const nurbs::SurfaceFoot pole = nurbs::closest(ball, {0, 0, -4});
  EXPECT_NEAR(pole.distance, 3, 1e-14);
  EXPECT_LT(length(pole.point - Vec3d{0, 0, -1}), 1e-7);
}

TEST(NurbsClosest, BeyondAnEdgeOrCornerOfASurfaceItIsThatExactly) {
  const Surface sheet = nurbs::plane({0, 0, 0}, {2, 0, 0}, {0, 1, 0});
  const nurbs::SurfaceFoot edge = nurbs::closest(sheet, {2.5, 0.3, 0.7}), corner = nurbs::closest(sheet, {-1, 3, 1});
  EXPECT_EQ(edge.u, 1.0);
  EXPECT_NEAR(edge.v, 0.3, 1e-14);
  EXPECT_EQ(corner.u, 0.0);
  EXPECT_EQ(corner.v, 1.0);
}

TEST(NurbsClosest, RefusesNumbersThatAreNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_REFUSED(nurbs::closest(nurbs::sphere({}, 1), {nan, 0, 0}), "closest: the point is not a number");
  EXPECT_REFUSED(nurbs::closest(nurbs::line({}, {1, 0, 0}), {0, nan, 0}), "closest: the point is not a number");
}
