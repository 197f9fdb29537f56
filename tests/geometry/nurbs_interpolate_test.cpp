#include <limits>

#include <trocar/geometry/nurbs_shapes/interpolate.hpp>

#include "nurbs_cases.hpp"

using namespace trocar;
namespace nurbs = trocar::geometry::nurbs;
using nurbs::Curve;
using nurbs::Spacing;

namespace {

std::vector<Vec3d> random_walk(int n, std::uint64_t seed) {
  core::Random random(seed);
  std::vector<Vec3d> points;
  for (int i = 0; i < n; ++i) points.push_back(0.5 * nurbs::random_place(random) + Vec3d{double(i), 0, 0});
  return points;
}
std::vector<Vec3d> random_ring(int n, std::uint64_t seed) {
  core::Random random(seed);
  std::vector<Vec3d> points;
  for (int i = 0; i < n; ++i) {
    const double a = portable::two_pi * i / n;
    points.push_back(Vec3d{portable::cos(a), portable::sin(a), 0} + 0.1 * nurbs::random_place(random));
  }
  return points;
}

}  // namespace

TEST(NurbsInterpolation, PassesThroughEveryPointWithEveryDegree) {  // [PT97 A9.1] [PT97 eq.9.8]
  for (Spacing spacing : {Spacing::chord, Spacing::centripetal})
    for (int degree = 1; degree <= 6; ++degree)
      for (int n : {2, 3, 5, 17}) {
        const auto points = random_walk(n, 71);
        const auto parameters = nurbs::parameters_by(spacing, points, "test");
        const Curve curve = nurbs::curve_through(points, degree, spacing);
        ASSERT_EQ(nurbs::fault_in(curve), "");
        EXPECT_EQ(curve.knots.degree, std::min(degree, n - 1));
        EXPECT_EQ(curve.points.front(), points.front());
        EXPECT_EQ(curve.points.back(), points.back());
        for (int i = 0; i < n; ++i)
          ASSERT_LT(length(nurbs::point(curve, parameters[i]) - points[i]), 1e-12) << degree << ' ' << n << ' ' << i;
      }
}

TEST(NurbsInterpolation, ClosedOnesPassThroughEveryPointSmoothly) {
  for (int degree = 1; degree <= 5; ++degree)
    for (int n : {6, 7, 20}) {
      const auto points = random_ring(n, 72);
      const auto parameters = nurbs::parameters_by(Spacing::chord, points, "test", true);
      const Curve curve = nurbs::closed_curve_through(points, degree);
      ASSERT_EQ(nurbs::fault_in(curve), "");
      EXPECT_EQ(curve.points.size(), points.size()) << "none is repeated";
      for (int i = 0; i < n; ++i)
        ASSERT_LT(length(nurbs::point(curve, parameters[i]) - points[i]), 1e-11) << degree << ' ' << n << ' ' << i;
    }
}

TEST(NurbsInterpolation, ReproducesACubicWhenGivenItsEndSlopes) {  // [PT97 eq.9.20]
  const auto cubic = [](double t) { return Vec3d{t, t * t - t, 2 * t * t * t - t * t}; };
  std::vector<Vec3d> points;
  for (double t : {0.0, 0.1, 0.45, 0.5, 0.9, 1.0}) points.push_back(cubic(t));
  // Parameters that are not the chords': the system itself.
  const std::vector<double> at{0.0, 0.1, 0.45, 0.5, 0.9, 1.0};
  const nurbs::Interpolation system(at, 3, true, true);
  std::vector<double> x;
  for (int i = 0; i < 6; ++i) {
    if (i == 5) x.insert(x.end(), {1, 1, 4});
    x.insert(x.end(), {points[i].x, points[i].y, points[i].z});
    if (i == 0) x.insert(x.end(), {1, -1, 0});
  }
  system.solve(x.data(), 3);
  Curve curve{system.knots(), {}, {}};
  for (std::size_t i = 0; i < x.size(); i += 3) curve.points.push_back({x[i], x[i + 1], x[i + 2]});
  for (double t = 0; t <= 1; t += 0.01) EXPECT_LT(length(nurbs::point(curve, t) - cubic(t)), 1e-14);

  const Curve sloped = nurbs::curve_through(points, 3, Spacing::chord, {Vec3d{1, 2, 3}, {}});
  EXPECT_LT(length(nurbs::jet(sloped, 0).first - Vec3d{1, 2, 3}), 1e-12);
}

TEST(NurbsInterpolation, RefusesPointsThatCoincideOrAreNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Vec3d> twice{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {2, 0, 0}}, none{{0, 0, 0}, {1, nan, 0}, {2, 0, 0}};
  EXPECT_REFUSED(nurbs::curve_through(twice), "points 1 and 2 coincide");
  EXPECT_REFUSED(nurbs::curve_through(none), "point 1 is not a number");
  EXPECT_REFUSED(nurbs::curve_through(std::vector<Vec3d>(1)), "at least 2 points expected, got 1");
  EXPECT_REFUSED(nurbs::closed_curve_through(std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}}),
                 "points 3 and 0 coincide");
  EXPECT_REFUSED(nurbs::closed_curve_through(random_ring(3, 73)), "more than 3 points expected around, got 3");
}
