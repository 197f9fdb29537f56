#include <trocar/geometry/nurbs/closure.hpp>
#include <trocar/geometry/nurbs/curve_edit.hpp>
#include <trocar/geometry/nurbs/surface_edit.hpp>
#include <trocar/geometry/nurbs_shapes/curve_makers.hpp>
#include <trocar/geometry/nurbs_shapes/interpolate.hpp>
#include <trocar/geometry/nurbs_shapes/skin.hpp>
#include <trocar/geometry/nurbs_shapes/surface_makers.hpp>
#include <trocar/geometry/nurbs_shapes/tube.hpp>

#include "nurbs_cases.hpp"

using namespace trocar;
namespace nurbs = trocar::geometry::nurbs;
using nurbs::Along;
using nurbs::CapShape;
using nurbs::Curve;
using nurbs::Spacing;
using nurbs::Surface;

namespace {

std::vector<Vec3d> random_ring(int n, std::uint64_t seed) {
  core::Random random(seed);
  std::vector<Vec3d> points;
  for (int i = 0; i < n; ++i) {
    const double a = portable::two_pi * i / n;
    points.push_back(Vec3d{portable::cos(a), portable::sin(a), 0} + 0.1 * nurbs::random_place(random));
  }
  return points;
}
Curve spiral() {
  std::vector<Vec3d> points;
  for (int i = 0; i < 9; ++i) {
    const double a = 0.5 * i;
    points.push_back({0.03 * portable::cos(a), 0.03 * portable::sin(a), 0.01 * a});
  }
  return nurbs::curve_through(points);
}
// Of the points of a ring about the spine at this parameter: how far from the spine's point, and out of its plane.
void expect_ring(const Surface& tube, const Curve& spine, double v, double radius, double tolerance) {
  const double u = spine.knots.start() + v * spine.knots.extent();
  const Vec3d centre = nurbs::point(spine, u), along = nurbs::tangent(spine, u);
  for (double t : nurbs::over(tube.u, 17)) {
    const Vec3d out = nurbs::point(tube, t, v) - centre;
    ASSERT_NEAR(length(out), radius, tolerance) << v;
    ASSERT_LT(std::fabs(dot(out, along)), tolerance) << v;
    ASSERT_GT(dot(nurbs::normal(tube, t, v), normalised(out)), 0.9) << "outwards";
  }
}

}  // namespace

TEST(NurbsSkin, CompatibleCurvesAreTheSameShapesOverTheSameKnots) {
  core::Random random(74);
  for (bool periodic : {false, true}) {
    const std::vector<Curve> mixed{nurbs::random_curve(random, 2, periodic, true),
                                   nurbs::random_curve(random, 3, periodic, false),
                                   nurbs::random_curve(random, 1, true, false)};
    const std::vector<Curve> alike = nurbs::compatible(mixed);
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_EQ(nurbs::fault_in(alike[k]), "");
      EXPECT_TRUE(alike[k].knots == alike[0].knots);
      EXPECT_EQ(alike[k].knots.periodic, periodic);
      EXPECT_LT(nurbs::apart(alike[k], nurbs::on_domain(mixed[k], 0, 1)), 1e-11) << k;
    }
  }
}

TEST(NurbsSkin, HasEverySectionAsItsCurve) {
  core::Random random(75);
  for (bool closed : {false, true}) {
    std::vector<Curve> sections;
    nurbs::SkinOptions options;
    options.closed = closed;
    for (int k = 0; k < 6; ++k) {
      const double a = portable::two_pi * k / 6;
      const Vec3d out{portable::cos(a), portable::sin(a), 0};
      sections.push_back(nurbs::ellipse(3.0 * out, (0.5 + 0.2 * random.uniform()) * out, {0, 0, 0.4}));
      options.parameters.push_back(closed ? k / 6.0 : k / 5.0);
    }
    const Surface s = nurbs::skinned(sections, options);
    EXPECT_EQ(s.v.periodic, closed);
    EXPECT_EQ(nurbs::closure_of(s).like_torus(), closed);
    for (int k = 0; k < 6; ++k)
      EXPECT_LT(nurbs::apart(nurbs::iso_curve(s, Along::u, options.parameters[k]), sections[k]), 1e-12) << k;
  }
  EXPECT_REFUSED(nurbs::skinned({nurbs::line({}, {1, 0, 0})}), "at least 2 sections expected, got 1");
  EXPECT_REFUSED(nurbs::skinned({nurbs::line({}, {1, 0, 0}), nurbs::line({}, {1, 0, 0})}), "sections 0 and 1 coincide");
}

TEST(NurbsSkin, RuledSurfaceIsStraightBetweenCurvesOfDifferentKinds) {
  core::Random random(76);
  const Curve a = nurbs::arc({}, {1, 0, 0}, {0, 1, 0}, 0, 3), b = nurbs::random_curve(random, 3, false, false);
  const Surface s = nurbs::ruled(a, b);
  for (double t : nurbs::over(a.knots, 30)) {
    const Vec3d p = nurbs::point(a, t), q = nurbs::point(b, b.knots.start() + t * b.knots.extent());
    ASSERT_LT(length(nurbs::point(s, t, 0.0) - p), 1e-12);
    ASSERT_LT(length(nurbs::point(s, t, 1.0) - q), 1e-12);
    const Vec3d m = nurbs::point(s, t, 0.5);
    ASSERT_LT(length(cross(m - p, q - p)), 1e-11) << "on the line between";
  }
}

TEST(NurbsSkin, SurfaceThroughAGridOfPointsHasThemAllAtMeanParameters) {  // [PT97 A9.4]
  std::vector<Vec3d> points;
  for (int j = 0; j < 5; ++j)
    for (int i = 0; i < 7; ++i) points.push_back({0.1 * i * i, 0.3 * j * j, 0.3 * portable::sin(i + 0.7 * j)});
  std::vector<double> u(7, 0.0), v(5, 0.0);
  for (int j = 0; j < 5; ++j) {
    const auto row = nurbs::parameters_by(Spacing::chord, std::span(points).subspan(7 * j, 7), "test");
    for (int i = 0; i < 7; ++i) u[i] += row[i] / 5;
  }
  for (int i = 0; i < 7; ++i) {
    std::vector<Vec3d> column;
    for (int j = 0; j < 5; ++j) column.push_back(points[i + 7 * j]);
    const auto along = nurbs::parameters_by(Spacing::chord, column, "test");
    for (int j = 0; j < 5; ++j) v[j] += along[j] / 7;
  }
  const Surface s = nurbs::surface_through(points, 7, 5);
  EXPECT_EQ(s.points.size(), points.size());
  for (int j = 0; j < 5; ++j)
    for (int i = 0; i < 7; ++i)
      ASSERT_LT(length(nurbs::point(s, u[i], v[j]) - points[i + 7 * j]), 1e-12) << i << ' ' << j;
  EXPECT_REFUSED(nurbs::surface_through(points, 7, 4), "as many as the counts say");
}

TEST(NurbsTube, OfAStraightSpineIsACylinderExactly) {
  const Curve spine = nurbs::line({0.01, 0, 0}, {0.01, 0, 0.2});
  const Surface wall = nurbs::tube(spine, {0.005});
  for (double v : nurbs::over(wall.v, 33)) expect_ring(wall, spine, v, 0.005, 1e-15);
}

TEST(NurbsTube, HasItsRadiusAtEveryStationAndHardlyAnotherBetween) {
  const Curve spine = spiral();
  const std::vector<double> ends = nurbs::breaks(spine.knots);
  std::vector<double> radii;
  for (std::size_t k = 0; k < ends.size(); ++k) radii.push_back(k % 2 ? 0.006 : 0.004);
  const Surface wall = nurbs::tube(spine, radii);
  for (std::size_t k = 0; k < ends.size(); ++k) expect_ring(wall, spine, ends[k], radii[k], 1e-12);
  const Surface even = nurbs::tube(spine, {0.004});
  for (double v : nurbs::over(even.v, 61)) expect_ring(even, spine, v, 0.004, 4e-6);  // a thousandth
  EXPECT_REFUSED(nurbs::tube(spine, {0.1, 0.2}), "one at each of");
  EXPECT_REFUSED(nurbs::tube(spine, {0.0}), "radius 0 above 0 expected, got 0");
}

TEST(NurbsTube, RadiiBetweenKnotsStayBetweenTheirNeighbours) {
  const Curve spine = nurbs::polyline(std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}});
  const Surface wall = nurbs::tube(spine, {0.1, 0.1, 0.3, 0.3, 0.2}, {8, {0, 0, 1}});
  for (double v : nurbs::over(wall.v, 201)) {
    const double r = length(nurbs::point(wall, 0.1, v) - nurbs::point(spine, v));
    ASSERT_GT(r, 0.1 - 1e-3) << v;
    ASSERT_LT(r, 0.3 + 1e-3) << v;
  }
}

TEST(NurbsTube, DoesNotTwistAndClosesAroundAClosedSpine) {
  const Curve ring = nurbs::closed_curve_through(random_ring(8, 77));
  const Surface wall = nurbs::tube(ring, {0.05});
  EXPECT_TRUE(nurbs::closure_of(wall).like_torus());
  EXPECT_GT(nurbs::volume(wall), 0.0);
  const double around = nurbs::volume(wall) / (portable::pi * 0.05 * 0.05);  // Pappus: the spine's length
  double way = 0.0;
  for (double u : nurbs::over(ring.knots, 2001)) way += length(nurbs::jet(ring, u).first) / 2000;
  EXPECT_NEAR(around / way, 1, 2e-3);
  // Neighbouring sections' u = 0 look the same way.
  for (double v : nurbs::over(wall.v, 101)) {
    const auto out = [&](double at) { return normalised(nurbs::point(wall, 0, at) - nurbs::point(ring, at)); };
    ASSERT_GT(dot(out(v), out(v + 0.01)), 0.95) << v;
  }
}

// Carried around a ring that is not flat, a frame comes back turned; the tube has its share of that everywhere.
TEST(NurbsTube, HasNoStepAtTheSeamOfARingThatIsNotFlat) {
  std::vector<Vec3d> points;
  for (int i = 0; i < 24; ++i) {
    const double a = portable::two_pi * i / 24;
    points.push_back(
        {portable::cos(a), portable::sin(a) + 0.3 * portable::cos(2 * a), 0.5 * portable::sin(2 * a + 0.5)});
  }
  const Curve ring = nurbs::closed_curve_through(points);
  const Surface wall = nurbs::tube(ring, {0.05});
  const auto out = [&](double v) { return normalised(nurbs::point(wall, 0, v) - nurbs::point(ring, v)); };
  std::vector<double> twists;
  double sum = 0.0, most = 0.0;
  for (int k = 0; k < 400; ++k) {
    const double v = k / 400.0;
    twists.push_back(dot(cross(out(v), out(v + 0.0025)), nurbs::tangent(ring, v)));
    sum += twists.back();
  }
  for (double twist : twists) most = std::max(most, std::fabs(twist - sum / 400));
  EXPECT_GT(std::fabs(sum), 0.2) << "a ring that turns frames";
  EXPECT_LT(most, 0.2 * std::fabs(sum) / 4) << "and not within the four samples of one station";
  std::printf("ring: turned by %.3f, a step by at most %.4f more or less than the mean\n", sum, most);
}

TEST(NurbsTube, CappedOnesEncloseTheirFormulasVolume) {
  const double r = 0.02, h = 0.1, pi = portable::pi;
  const Surface pipe = nurbs::cylinder({0.1, 0.2, 0.3}, {0, h, 0}, r);
  const double barrel = pi * r * r * h, dome = 2.0 / 3 * pi * r * r * r;
  const auto v = [&](CapShape a, CapShape b) { return nurbs::volume(nurbs::capped(pipe, a, b)); };
  EXPECT_NEAR(v(CapShape::flat, CapShape::flat) / barrel, 1, 1e-7);
  EXPECT_NEAR(v(CapShape::round, CapShape::round) / (barrel + 2 * dome), 1, 1e-7);
  EXPECT_NEAR(v(CapShape::flat, CapShape::round) / (barrel + dome), 1, 1e-7);
  const Surface tip = nurbs::capped(nurbs::cone({}, {0, 0, h}, r, 0), CapShape::flat, CapShape::none);
  EXPECT_NEAR(nurbs::volume(tip) / (barrel / 3), 1, 1e-7);
  EXPECT_FALSE(nurbs::closure_of(nurbs::capped(pipe, CapShape::none, CapShape::flat)).closed());
  EXPECT_REFUSED(nurbs::capped(nurbs::plane({}, {1, 0, 0}, {0, 1, 0}), CapShape::flat, CapShape::flat), "closed in u");
  // The wall is what it was.
  const Surface solid = nurbs::capped(nurbs::tube(spiral(), {0.004}), CapShape::round, CapShape::flat);
  EXPECT_TRUE(nurbs::closure_of(solid).like_sphere());
  EXPECT_GT(nurbs::volume(solid), 0.0);
}

TEST(NurbsTube, HollowOneIsTheWallBetweenTwoTubes) {
  const double r = 0.02, h = 0.1, t = 0.005, pi = portable::pi;
  const Surface pipe = nurbs::hollow_tube(nurbs::line({}, {0, 0, h}), {r}, t);
  EXPECT_TRUE(nurbs::closure_of(pipe).like_torus());
  EXPECT_NEAR(nurbs::volume(pipe) / (pi * (r * r - (r - t) * (r - t)) * h), 1, 1e-7);
  EXPECT_NEAR(nurbs::area(pipe) / (2 * pi * (2 * r - t) * h + 2 * pi * (r * r - (r - t) * (r - t))), 1, 1e-7);
  EXPECT_REFUSED(nurbs::hollow_tube(nurbs::line({}, {0, 0, h}), {r}, r), "a thickness below every radius");
}

TEST(NurbsShapes, RevolvedByAnAngleIsAPartOfTheWhole) {  // [PT97 A8.1]
  core::Random random(78);
  const Curve outline = nurbs::random_curve(random, 3, false, true);
  const Vec3d axis = normalised(Vec3d{1, 1, 1});
  const Surface part = nurbs::revolved(outline, {1, 0, 0}, axis, 2.0),
                whole = nurbs::revolved(outline, {1, 0, 0}, axis);
  for (double v : nurbs::over(outline.knots, 13)) {
    const Vec3d start = nurbs::point(outline, v) - Vec3d{1, 0, 0};
    const Vec3d foot = dot(start, axis) * axis, x = start - foot, y = cross(axis, x);
    const Vec3d end = foot + portable::cos(2.0) * x + portable::sin(2.0) * y;
    ASSERT_LT(length(nurbs::point(part, 0, v) - Vec3d{1, 0, 0} - start), 1e-13);
    ASSERT_LT(length(nurbs::point(part, 1, v) - Vec3d{1, 0, 0} - end), 1e-13);
    for (double u : nurbs::over(part.u, 13)) {
      for (const Surface* s : {&part, &whole}) {
        const Vec3d p = nurbs::point(*s, u, v) - Vec3d{1, 0, 0};
        ASSERT_NEAR(dot(p, axis), dot(start, axis), 1e-13);
        ASSERT_NEAR(length(p - dot(p, axis) * axis), length(x), 1e-13);
      }
    }
  }
  EXPECT_TRUE(whole.u.periodic);
}
