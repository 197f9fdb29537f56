#include <trocar/geometry/nurbs/closure.hpp>
#include <trocar/geometry/nurbs/mesh.hpp>
#include <trocar/geometry/nurbs/spline_bridge.hpp>
#include <trocar/geometry/surfaces/loft.hpp>

#include "nurbs_cases.hpp"

using namespace trocar;
namespace nurbs = trocar::geometry::nurbs;

TEST(NurbsBridge, SplinesBecomeTheSameShapesAndComeBack) {
  nurbs::each_curve(91, 2, 4, [](const nurbs::Curve& curve) {
    const geometry::NurbsCurve spline = nurbs::spline_of(curve);
    for (double u : nurbs::over(curve.knots, 67))
      ASSERT_LT(length(spline.point(u) - nurbs::point(curve, u)), 1e-13) << u;
    const nurbs::Curve back = nurbs::nurbs_of(spline);
    EXPECT_TRUE(back.knots == curve.knots);
    EXPECT_EQ(back.points, curve.points);
    EXPECT_EQ(back.weights, curve.weights);
  });
  core::Random random(92);
  for (int kind = 0; kind < 8; ++kind) {
    const nurbs::Surface s = nurbs::random_surface(random, 3, 2, kind & 1, kind & 2, kind & 4);
    const geometry::NurbsSurface spline = nurbs::spline_of(s);
    for (double v : nurbs::over(s.v, 13))
      for (double u : nurbs::over(s.u, 13)) ASSERT_LT(length(spline.point(u, v) - nurbs::point(s, u, v)), 1e-13);
    const nurbs::Surface back = nurbs::nurbs_of(spline);
    EXPECT_EQ(back.points, s.points);
    EXPECT_EQ(back.weights, s.weights);
  }
}

TEST(NurbsBridge, ALoftedOrganIsAClosedBody) {
  std::vector<geometry::Section> sections;
  for (int i = 0; i < 4; ++i) sections.push_back({{0, 0.002 * i * i, 0.02 * i}, {0.012, 0, 0}, {0, 0.009, 0}, 2.3});
  const geometry::NurbsSurface lofted = geometry::loft(sections);
  const nurbs::Surface body = nurbs::nurbs_of(lofted);
  EXPECT_TRUE(nurbs::closure_of(body).like_sphere());
  EXPECT_EQ(body.points.size() + 3u * static_cast<std::size_t>(lofted.count_v), lofted.control.size()) << "no repeats";
  const auto mesh = nurbs::tessellate(body, nurbs::Steps{3, 3}).mesh;
  EXPECT_TRUE(geometry::check_edges(mesh).closed());
  EXPECT_NEAR(geometry::volume(mesh) / geometry::volume(geometry::tessellate(lofted, 0.001)), 1, 0.01);
  EXPECT_NEAR(std::fabs(nurbs::volume(body)) / geometry::volume(mesh), 1, 0.02);
}

TEST(NurbsBridge, RefusesSplinesThatDoNotRepeat) {
  geometry::NurbsCurve ring =
      geometry::periodic_cubic(std::vector<Vec3d>{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}});
  EXPECT_EQ(nurbs::nurbs_of(ring).points.size(), 4u);
  ring.control.back().x += 0.1;
  EXPECT_REFUSED(nurbs::nurbs_of(ring), "repeat the first");
  ring.control.pop_back();
  EXPECT_REFUSED(nurbs::nurbs_of(ring), "as many control points");
  core::Random random(93);
  EXPECT_REFUSED(nurbs::spline_of(nurbs::random_curve(random, 8, false, false)), "a degree up to 7");
}
