#include <stdexcept>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/geometry/curves/polyline.hpp>
#include <trocar/geometry/curves/spline.hpp>
#include <trocar/numerics/portable.hpp>

using namespace trocar;
using namespace trocar::geometry;

namespace {

Vec3d random_point(core::Random& random) {
  const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
  return {x, y, z};
}
std::vector<Vec3d> random_points(int n, std::uint64_t seed) {
  core::Random random(seed);
  std::vector<Vec3d> points;
  for (int i = 0; i < n; ++i) points.push_back(random_point(random) + Vec3d{double(i), 0, 0});
  return points;
}
void expect_derivatives_match_differences(const NurbsCurve& curve, double tolerance) {
  const double h = 1e-5;
  for (double u = 0.013; u < 1; u += 0.0371) {
    const CurvePoint at = curve.at(u), before = curve.at(u - h), after = curve.at(u + h);
    const double scale = 1 + length(at.second);
    EXPECT_LT(length((after.point - before.point) / (2 * h) - at.first), tolerance * scale) << u;
    EXPECT_LT(length((after.first - before.first) / (2 * h) - at.second), tolerance * scale) << u;
  }
}
// A quarter circle, exact as a quadratic NURBS.  [Piegl & Tiller, section 7.2]
NurbsCurve quarter_circle() {
  NurbsCurve arc;
  arc.degree = 2;
  arc.knots = {0, 0, 0, 1, 1, 1};
  arc.control = {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  arc.weights = {1, std::sqrt(0.5), 1};
  return arc;
}

}  // namespace

TEST(Basis, FunctionsSumToOneAndDerivativesToZeroForAnyDegreeAndRepeatedKnots) {
  for (int degree = 1; degree <= 5; ++degree) {
    std::vector<double> knots(degree + 1, 0.0);
    for (double k : {0.2, 0.35, 0.35, 0.8}) knots.push_back(k);
    knots.insert(knots.end(), degree + 1, 1.0);
    for (double u : {0.0, 0.1, 0.2, 0.35, 0.5, 0.8, 0.99, 1.0}) {
      const Basis b = basis_functions(knots, degree, u);
      double sum = 0, slope = 0, bend = 0;
      for (int k = 0; k <= degree; ++k) {
        EXPECT_GE(b.value[0][k], -1e-15);
        sum += b.value[0][k], slope += b.value[1][k], bend += b.value[2][k];
      }
      EXPECT_NEAR(sum, 1, 1e-14) << degree << ' ' << u;
      EXPECT_NEAR(slope, 0, 1e-11) << degree << ' ' << u;
      EXPECT_NEAR(bend, 0, 1e-9) << degree << ' ' << u;
    }
  }
}

TEST(Curve, DerivativesMatchDifferencesForClampedPeriodicAndRational) {
  expect_derivatives_match_differences(clamped_cubic(random_points(9, 1)), 2e-5);
  expect_derivatives_match_differences(periodic_cubic(random_points(9, 2)), 2e-5);
  NurbsCurve rational = clamped_cubic(random_points(9, 3));
  core::Random random(4);
  for (std::size_t i = 0; i < rational.control.size(); ++i) rational.weights.push_back(random.uniform(0.3, 3));
  expect_derivatives_match_differences(rational, 2e-5);
  expect_derivatives_match_differences(quarter_circle(), 1e-8);
}

TEST(Curve, ClampedOneStartsAndEndsInItsEndPointsAlongItsPolygon) {
  const auto control = random_points(7, 5);
  const NurbsCurve curve = clamped_cubic(control);
  EXPECT_LT(length(curve.point(0) - control.front()), 1e-15);
  EXPECT_LT(length(curve.point(1) - control.back()), 1e-15);
  EXPECT_LT(length(cross(curve.at(0).first, control[1] - control[0])), 1e-12);
  EXPECT_EQ(curve.point(7).x, curve.point(1).x);
}

TEST(Curve, PeriodicOneIsC2AcrossItsSeam) {
  const NurbsCurve curve = periodic_cubic(random_points(6, 6));
  const CurvePoint before = curve.at(1 - 1e-9), after = curve.at(1e-9), wrapped = curve.at(1);
  EXPECT_LT(length(before.point - after.point), 1e-6);
  EXPECT_LT(length(before.first - after.first), 1e-4);
  EXPECT_LT(length(before.second - after.second), 1e-4);
  EXPECT_EQ(wrapped.point, curve.at(0).point);
  EXPECT_LT(length(curve.point(2.25) - curve.point(0.25)), 1e-13);
}

TEST(Curve, RationalQuadraticIsAnExactCircle) {
  const NurbsCurve arc = quarter_circle();
  for (double u = 0; u <= 1; u += 0.01) {
    const CurvePoint at = arc.at(u);
    EXPECT_NEAR(length(at.point), 1, 1e-15);
    const double speed = length(at.first);
    EXPECT_NEAR(length(cross(at.first, at.second)) / (speed * speed * speed), 1, 1e-12) << "curvature";
  }
}

TEST(Interpolation, PassesThroughEveryPointWithContinuousCurvature) {
  for (int n : {2, 3, 4, 15}) {
    const auto points = random_points(n, 7);
    const auto parameters = chord_parameters(points);
    const NurbsCurve curve = interpolated(points);
    for (int i = 0; i < n; ++i) EXPECT_LT(length(curve.point(parameters[i]) - points[i]), 1e-13) << n << ' ' << i;
    EXPECT_LT(length(curve.at(0).second), 1e-9) << "natural end";
    EXPECT_LT(length(curve.at(1).second), 1e-9) << "natural end";
    for (int i = 1; i + 1 < n; ++i) {
      const CurvePoint left = curve.at(parameters[i] - 1e-10), right = curve.at(parameters[i] + 1e-10);
      EXPECT_LT(length(left.second - right.second), 1e-5 * (1 + length(left.second)));
    }
  }
}

TEST(Interpolation, ReproducesACubicWhenGivenItsEndSlopes) {
  const auto cubic = [](double t) { return Vec3d{t, t * t - t, 2 * t * t * t - t * t}; };
  std::vector<Vec3d> points;
  const std::vector<double> parameters{0, 0.1, 0.45, 0.5, 0.9, 1};
  for (double t : parameters) points.push_back(cubic(t));
  const NurbsCurve curve = interpolated(points, parameters, {Vec3d{1, -1, 0}, Vec3d{1, 1, 4}});
  for (double t = 0; t <= 1; t += 0.01) EXPECT_LT(length(curve.point(t) - cubic(t)), 1e-14);
}

TEST(Interpolation, ClosedOnePassesThroughEveryPointAndIsC2AtTheSeam) {
  for (int n : {3, 4, 5, 20}) {
    std::vector<Vec3d> points;
    core::Random random(8);
    for (int i = 0; i < n; ++i) {
      const double a = 2 * portable::pi * i / n;
      points.push_back(Vec3d{portable::cos(a), portable::sin(a), 0} + 0.2 * random_point(random));
    }
    const auto parameters = chord_parameters(points, true);
    const NurbsCurve curve = interpolated_closed(points);
    EXPECT_NEAR(curve.start(), 0, 1e-15);
    EXPECT_NEAR(curve.end(), 1, 1e-15);
    for (int i = 0; i < n; ++i) EXPECT_LT(length(curve.point(parameters[i]) - points[i]), 1e-13) << n << ' ' << i;
    EXPECT_LT(length(curve.at(1 - 1e-10).second - curve.at(1e-10).second), 1e-4);
  }
}

TEST(Interpolation, CoincidingPointsAreRefused) {
  const std::vector<Vec3d> points{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  EXPECT_THROW(interpolated(points), std::invalid_argument);
  EXPECT_THROW(interpolated_closed(std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(clamped_cubic(std::vector<Vec3d>(3)), std::invalid_argument);
}

TEST(Surface, ProductOfTwoArcsIsASphereOctantWithMatchingDerivatives) {
  // A quarter circle in x-z turned by a quarter about z: weights multiply.
  const NurbsCurve arc = quarter_circle();
  NurbsSurface s;
  s.degree_u = s.degree_v = 2;
  s.knots_u = s.knots_v = arc.knots;
  s.count_u = s.count_v = 3;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const double radius = arc.control[j].x, height = arc.control[j].y;
      s.control.push_back({radius * arc.control[i].x, radius * arc.control[i].y, height});
      s.weights.push_back(arc.weights[i] * arc.weights[j]);
    }
  const double h = 1e-6;
  for (double u = 0.05; u < 1; u += 0.1)
    for (double v = 0.05; v < 0.95; v += 0.1) {
      const SurfacePoint at = s.at(u, v);
      EXPECT_NEAR(length(at.point), 1, 1e-14);
      EXPECT_LT(length((s.point(u + h, v) - s.point(u - h, v)) / (2 * h) - at.du), 1e-8);
      EXPECT_LT(length((s.point(u, v + h) - s.point(u, v - h)) / (2 * h) - at.dv), 1e-8);
      EXPECT_LT(length(at.normal() - at.point), 1e-13);
    }
}

TEST(Polyline, ResamplingGivesEqualSteps) {
  const Polyline line({{0, 0, 0}, {3, 0, 0}, {3, 0, 0}, {3, 4, 0}});
  EXPECT_DOUBLE_EQ(line.length(), 7);
  const auto points = line.resampled(8);
  EXPECT_LT(length(points[2] - Vec3d{2, 0, 0}), 1e-14);
  EXPECT_LT(length(points[5] - Vec3d{3, 2, 0}), 1e-14);
  EXPECT_EQ(points.back(), (Vec3d{3, 4, 0}));
  EXPECT_EQ(line.resampled_by_step(0.5).size(), 15u);
  EXPECT_EQ(line.point(-1), (Vec3d{0, 0, 0}));
  EXPECT_EQ(line.point(99), (Vec3d{3, 4, 0}));
  EXPECT_EQ(Polyline({{1, 2, 3}}).point(0.5), (Vec3d{1, 2, 3}));
}

TEST(Polyline, CurveIsSampledAtEqualWays) {
  const NurbsCurve curve = interpolated(random_points(8, 9));
  const auto parameters = arc_parameters(curve, 40);
  std::vector<double> ways;
  for (int i = 0; i + 1 < 40; ++i) {
    double way = 0;
    for (int k = 0; k < 200; ++k) {
      const double a = parameters[i] + (parameters[i + 1] - parameters[i]) * k / 200;
      const double b = parameters[i] + (parameters[i + 1] - parameters[i]) * (k + 1) / 200;
      way += length(curve.point(b) - curve.point(a));
    }
    ways.push_back(way);
  }
  for (double way : ways) EXPECT_NEAR(way / ways[0], 1, 1e-3);
  EXPECT_NEAR(length(curve), 39 * ways[0], 1e-3 * length(curve));
}
