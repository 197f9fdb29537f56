#include <limits>

#include <trocar/geometry/nurbs_fit/curve_fit.hpp>

#include "nurbs_cases.hpp"

using namespace trocar;
namespace nurbs = trocar::geometry::nurbs;
using nurbs::Curve;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Points of a wavy ring, and of an open wave.
std::vector<Vec3d> wave(int n) {
  std::vector<Vec3d> points;
  for (int i = 0; i < n; ++i) {
    const double t = i / (n - 1.0);
    points.push_back({t, 0.2 * portable::sin(5 * t), 0.1 * portable::cos(9 * t)});
  }
  return points;
}
std::vector<Vec3d> wavy_ring(int n) {
  std::vector<Vec3d> points;
  for (int i = 0; i < n; ++i) {
    const double a = portable::two_pi * i / n, r = 1 + 0.1 * portable::cos(4 * a);
    points.push_back({r * portable::cos(a), r * portable::sin(a), 0.1 * portable::sin(3 * a)});
  }
  return points;
}

}  // namespace

TEST(NurbsCurveFit, ReturnsTheCurveThatThePointsAreOf) {
  core::Random random(81);
  Curve truth{nurbs::clamped_uniform(3, 7), {}, {}};
  for (int i = 0; i < 7; ++i) truth.points.push_back({double(i), random.uniform(-1, 1), random.uniform(-1, 1)});
  std::vector<Vec3d> points;
  for (double u : nurbs::over(truth.knots, 200)) points.push_back(nurbs::point(truth, u));
  nurbs::CurveFitOptions options;
  options.rounds = 200;
  const nurbs::CurveFit fit = nurbs::fit_curve(points, 12, options);
  EXPECT_LT(fit.greatest, 1e-2) << "of a curve about 8 long";
  EXPECT_EQ(fit.curve.points.front(), points.front());
  EXPECT_EQ(fit.curve.points.back(), points.back());
  EXPECT_EQ(fit.residuals.size(), points.size());
  // With a point for each control point it is interpolation.
  const nurbs::CurveFit exact = nurbs::fit_curve(wave(9), 9);
  EXPECT_LT(exact.greatest, 1e-10);
}

TEST(NurbsCurveFit, MoreControlPointsComeNearer) {  // [PT97 eq.9.69]
  for (bool closed : {false, true}) {
    nurbs::CurveFitOptions options;
    options.closed = closed;
    double last = 1e9;
    for (int n : {6, 10, 18, 34}) {
      const nurbs::CurveFit fit = nurbs::fit_curve(closed ? wavy_ring(200) : wave(200), n, options);
      EXPECT_EQ(static_cast<int>(fit.curve.points.size()), n);
      EXPECT_EQ(fit.curve.knots.periodic, closed);
      EXPECT_LT(fit.rms, 0.6 * last) << n;
      last = fit.rms;
    }
    EXPECT_LT(last, 1e-4);
  }
}

TEST(NurbsCurveFit, WithinAToleranceTakesFewerControlPointsThanPoints) {
  for (bool closed : {false, true}) {
    nurbs::CurveFitOptions options;
    options.closed = closed;
    std::size_t last = 0;
    for (double tolerance : {1e-2, 1e-3, 1e-4}) {
      const nurbs::CurveFit fit = nurbs::fit_curve_within(closed ? wavy_ring(300) : wave(300), tolerance, options);
      EXPECT_LE(fit.greatest, tolerance);
      EXPECT_GE(fit.curve.points.size(), last);
      EXPECT_LT(fit.curve.points.size(), 80u);
      last = fit.curve.points.size();
    }
  }
}

TEST(NurbsCurveFit, KeepsTheSlopesOfItsEnds) {
  nurbs::CurveFitOptions options;
  options.slopes = {Vec3d{1, 2, 0}, Vec3d{1, 0, -1}};
  const nurbs::CurveFit fit = nurbs::fit_curve(wave(100), 15, options);
  EXPECT_LT(length(nurbs::jet(fit.curve, 0).first - Vec3d{1, 2, 0}), 1e-12);
  EXPECT_LT(length(nurbs::jet(fit.curve, 1).first - Vec3d{1, 0, -1}), 1e-12);
}

TEST(NurbsCurveFit, RefusesWhatCannotBeFitted) {
  EXPECT_REFUSED(nurbs::fit_curve(wave(10), 11), "from 4 to 10 control points expected, got 11");
  EXPECT_REFUSED(nurbs::fit_curve(wave(3), 3), "at least 4 points expected, got 3");
  std::vector<Vec3d> points = wave(10);
  points[4].y = kNan;
  EXPECT_REFUSED(nurbs::fit_curve(points, 5), "point 4 is not a number");
  points[4] = points[5];
  EXPECT_REFUSED(nurbs::fit_curve(points, 5), "points 4 and 5 coincide");
  EXPECT_REFUSED(nurbs::fit_curve_within(wave(10), 0.0), "a tolerance above 0");
}
