#include <limits>

#include <trocar/geometry/nurbs/basis.hpp>
#include <trocar/geometry/nurbs/curve_edit.hpp>
#include <trocar/geometry/nurbs/curve_length.hpp>
#include <trocar/geometry/nurbs_shapes/curve_makers.hpp>

#include "nurbs_cases.hpp"

using namespace trocar;
namespace nurbs = trocar::geometry::nurbs;
using nurbs::Curve;

TEST(NurbsCurve, PointsAreSumsOfRationalFunctions) {  // [PT97 eq.4.1]: the definition, function by function
  nurbs::each_curve(11, 1, 5, [](const Curve& curve) {
    for (double u : nurbs::over(curve.knots, 37)) {
      const double inside = nurbs::into_domain(curve.knots, u);
      Vec3d sum;
      double weight = 0.0;
      for (int i = 0; i < curve.knots.functions(); ++i) {
        const int p = curve.knots.point_of(i);
        const double n = nurbs::basis_function(curve.knots, i, inside) * curve.weight(p);
        sum += n * curve.points[p], weight += n;
      }
      ASSERT_LT(length(sum / weight - nurbs::point(curve, u)), 1e-13) << u;
    }
  });
}

TEST(NurbsCurve, DerivativesOfEveryOrderMatchDifferences) {  // [PT97 A3.2] [PT97 A4.2]
  const double h = 1e-5;
  nurbs::each_curve(12, 1, 6, [h](const Curve& curve) {
    for (double u = curve.knots.start() + 0.0137; u < curve.knots.end(); u += 0.0931) {
      const int span = nurbs::span_of(curve.knots, u);
      if (u - h < curve.knots.values[span] || u + h > curve.knots.values[span + 1]) continue;
      const auto at = nurbs::derivatives(curve, u, 5), before = nurbs::derivatives(curve, u - h, 5),
                 after = nurbs::derivatives(curve, u + h, 5);
      double size = 1.0;
      for (int d = 1; d <= 5; ++d) {
        size = std::max(size, length(at[d]));
        ASSERT_LT(length((after[d - 1] - before[d - 1]) / (2 * h) - at[d]), 1e-5 * size) << u << ' ' << d;
      }
      const nurbs::CurveJet jet = nurbs::jet(curve, u);  // [PT97 eq.4.8], the quick way
      ASSERT_LT(length(jet.point - at[0]) + length(jet.first - at[1]), 1e-12 * size);
      ASSERT_LT(length(jet.second - at[2]), 1e-11 * size);
    }
  });
}

TEST(NurbsCurve, ClampedOneStartsAndEndsInItsEndPointsAlongItsPolygon) {
  core::Random random(13);
  const Curve curve = nurbs::random_curve(random, 4, false, true);
  EXPECT_LT(length(nurbs::point(curve, 1.0) - curve.points.front()), 1e-15);
  EXPECT_LT(length(nurbs::point(curve, 4.0) - curve.points.back()), 1e-15);
  EXPECT_EQ(nurbs::point(curve, 99.0), nurbs::point(curve, 4.0));
  EXPECT_LT(length(cross(nurbs::jet(curve, 1.0).first, curve.points[1] - curve.points[0])), 1e-12);
}

TEST(NurbsCurve, PeriodicOneIsAsSmoothAtItsSeamAsItsKnotsSay) {
  core::Random random(14);
  Curve curve = nurbs::random_curve(random, 4, true, true);
  const auto before = nurbs::derivatives(curve, curve.knots.end() - 1e-9, 3),
             after = nurbs::derivatives(curve, curve.knots.start() + 1e-9, 3);
  for (int d = 0; d <= 3; ++d) EXPECT_LT(length(before[d] - after[d]), 1e-5 * (1 + length(after[d]))) << d;
  EXPECT_LT(length(nurbs::point(curve, 1.7) - nurbs::point(curve, 1.7 + 2 * curve.knots.extent())), 1e-13);
}

TEST(NurbsCurve, ControlPointMovesItsSupportOnly) {
  core::Random random(15);
  for (bool periodic : {false, true}) {
    const Curve curve = nurbs::random_curve(random, 3, periodic, true);
    for (int i = 0; i < curve.knots.points(); ++i) {
      Curve moved = curve;
      moved.points[i] += Vec3d{0, 0, 1};
      for (double u : nurbs::over(curve.knots, 83)) {
        double share = 0.0;
        for (int f = 0; f < curve.knots.functions(); ++f)
          if (curve.knots.point_of(f) == i)
            share += nurbs::basis_function(curve.knots, f, nurbs::into_domain(curve.knots, u));
        const double way = length(nurbs::point(moved, u) - nurbs::point(curve, u));
        ASSERT_EQ(way > 0.0, share > 0.0) << i << ' ' << u;
      }
    }
  }
}

TEST(NurbsCurve, CircleHasItsRadiusTangentAndCurvatureEverywhere) {
  const Vec3d centre{0.1, -0.2, 0.3}, axis = normalised(Vec3d{1, 2, 3});
  const double r = 0.02;
  for (const Curve& ring :
       {nurbs::circle(centre, Vec3d{1, 2, 3}, r), nurbs::opened(nurbs::circle(centre, Vec3d{1, 2, 3}, r))})
    for (double u : nurbs::over(ring.knots, 173)) {
      const Vec3d out = nurbs::point(ring, u) - centre, t = nurbs::tangent(ring, u), k = nurbs::curvature(ring, u);
      ASSERT_NEAR(length(out) / r, 1, 1e-12);
      ASSERT_LT(std::fabs(dot(out, axis)) / r, 1e-12);
      ASSERT_LT(length(t - cross(axis, out) / r), 1e-11) << "counter-clockwise about its axis";
      ASSERT_LT(length(k + out / (r * r)) * r, 1e-11) << u;
    }
  EXPECT_EQ(nurbs::circle(centre, axis, r).points.size(), 8u);
}

TEST(NurbsCurve, ArcIsTheEllipsesPartBetweenItsAngles) {  // [PT97 A7.1]
  const Vec3d centre{1, 2, 3}, x{0.3, 0, 0}, y{0, 0.1, 0.2};
  for (double start : {0.0, -2.0, 1.1})
    for (double whole : {0.01, 1.0, 0.5 * portable::pi, 2.9, 4.0, portable::two_pi}) {
      const Curve arc = nurbs::arc(centre, x, y, start, start + whole);
      const auto on_ellipse = [&](double a) { return centre + portable::cos(a) * x + portable::sin(a) * y; };
      EXPECT_LT(length(nurbs::point(arc, 0) - on_ellipse(start)), 1e-15);
      EXPECT_LT(length(nurbs::point(arc, 1) - on_ellipse(start + whole)), 1e-15);
      EXPECT_LT(length(nurbs::point(arc, 0.5) - on_ellipse(start + 0.5 * whole)), 1e-14);
      double last = -1.0;
      for (double u : nurbs::over(arc.knots, 57)) {
        const Vec3d d = nurbs::point(arc, u) - centre;
        const double c = d.x / 0.3, s = dot(d, y) / dot(y, y);
        ASSERT_NEAR(c * c + s * s, 1, 1e-12);
        double angle = portable::atan2(s, c) - start;
        while (angle < last) angle += portable::two_pi;
        last = std::min(angle, whole);  // goes on, and not beyond
        ASSERT_LE(angle, whole + 1e-9);
      }
    }
  EXPECT_REFUSED(nurbs::arc(centre, x, y, 1, 1), "an angle above 0 and up to 2 pi expected, got 0");
  EXPECT_REFUSED(nurbs::arc(centre, x, y, 0, 7), "got 7");
}

TEST(NurbsCurve, TangentIsThereWhereTheFirstDerivativeVanishes) {
  // Two control points coincide at an end: the curve leaves towards the third.
  Curve curve{nurbs::clamped_uniform(3, 4), {{0, 0, 0}, {0, 0, 0}, {1, 1, 0}, {2, 0, 0}}, {}};
  EXPECT_EQ(length(nurbs::jet(curve, 0).first), 0.0);
  EXPECT_LT(length(nurbs::tangent(curve, 0) - normalised(Vec3d{1, 1, 0})), 1e-12);
  curve.points = {{2, 0, 0}, {1, 1, 0}, {0, 0, 0}, {0, 0, 0}};
  EXPECT_LT(length(nurbs::tangent(curve, 1) - normalised(Vec3d{-1, -1, 0})), 1e-12);
  curve.points.assign(4, {1, 2, 3});
  EXPECT_EQ(nurbs::tangent(curve, 0.5), Vec3d{}) << "a point has no direction";
  EXPECT_EQ(nurbs::curvature(curve, 0.5), Vec3d{});
}

TEST(NurbsCurve, LengthOfCircleLineAndParabolaIsThatOfTheirFormulas) {
  EXPECT_NEAR(nurbs::length(nurbs::circle({1, 2, 3}, {0, 1, 1}, 0.03)) / (portable::two_pi * 0.03), 1, 1e-11);
  EXPECT_NEAR(nurbs::length(nurbs::line({0, 0, 0}, {3, 4, 12})), 13, 1e-13);
  // y = x^2 from 0 to 1, as a Bezier parabola.
  const Curve parabola{nurbs::clamped_uniform(2, 3), {{0, 0, 0}, {0.5, 0, 0}, {1, 1, 0}}, {}};
  EXPECT_NEAR(nurbs::length(parabola), std::sqrt(5.0) / 2 + portable::log(2 + std::sqrt(5.0)) / 4, 1e-12);
  EXPECT_NEAR(nurbs::length(parabola, 0, 0.4) + nurbs::length(parabola, 0.4, 1), nurbs::length(parabola), 1e-13);
}

TEST(NurbsCurve, ParametersByLengthAreEquallyFarApart) {
  core::Random random(16);
  for (bool periodic : {false, true}) {
    const Curve curve = nurbs::random_curve(random, 3, periodic, true);
    const auto parameters = nurbs::parameters_by_length(curve, 12);
    const double step = nurbs::length(curve) / 11;
    for (int i = 0; i < 11; ++i) ASSERT_NEAR(nurbs::length(curve, parameters[i], parameters[i + 1]) / step, 1, 1e-9);
    EXPECT_EQ(nurbs::parameter_after(curve, -1), curve.knots.start());
    EXPECT_EQ(nurbs::parameter_after(curve, 1e9), curve.knots.end());
  }
}

TEST(NurbsCurve, FaultyOnesAreRefusedByName) {
  core::Random random(17);
  const Curve good = nurbs::random_curve(random, 3, false, true);
  Curve bad = good;
  bad.weights[2] = 0.0;
  EXPECT_EQ(nurbs::fault_in(bad), "weight 2 above 0 expected, got 0");
  bad.weights[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(nurbs::fault_in(bad), "weight 2 above 0 expected, got nan");
  bad = good;
  bad.weights.pop_back();
  EXPECT_EQ(nurbs::fault_in(bad), "a weight for each of 13 control points expected, got 12");
  bad = good;
  bad.points.pop_back();
  EXPECT_EQ(nurbs::fault_in(bad), "the knots ask for 13 control points, got 12");
  bad = good;
  bad.points[4].y = std::numeric_limits<double>::infinity();
  EXPECT_EQ(nurbs::fault_in(bad), "control point 4 is not a number");
  EXPECT_REFUSED(nurbs::inserted(bad, 2.0), "inserted: control point 4 is not a number");
  EXPECT_REFUSED(nurbs::length(bad), "length: control point 4");
  EXPECT_REFUSED(nurbs::circle({}, {0, 0, 0}, 1), "a normal expected");
  EXPECT_REFUSED(nurbs::circle({}, {0, 0, 1}, 0), "a radius above 0");
  EXPECT_REFUSED(nurbs::polyline(std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}}), "points 1 and 2 coincide");
}
