#include <limits>

#include <trocar/geometry/nurbs/basis.hpp>
#include <trocar/geometry/nurbs/closure.hpp>
#include <trocar/geometry/nurbs/surface_edit.hpp>
#include <trocar/geometry/nurbs_shapes/curve_makers.hpp>
#include <trocar/geometry/nurbs_shapes/surface_makers.hpp>

#include "nurbs_cases.hpp"

using namespace trocar;
namespace nurbs = trocar::geometry::nurbs;
using nurbs::Along;
using nurbs::Surface;

namespace {

constexpr double kSame = 1e-12;

// Every kind of surface once, of two different degrees.
template <class Act>
void each_surface(std::uint64_t seed, const Act& act) {
  core::Random random(seed);
  for (int kind = 0; kind < 8; ++kind)
    for (int degree = 1; degree <= 4; ++degree) {
      const bool around_u = kind & 1, around_v = kind & 2, rational = kind & 4;
      SCOPED_TRACE(::testing::Message() << "degrees " << degree << ' ' << 5 - degree << (around_u ? ", u periodic" : "")
                                        << (around_v ? ", v periodic" : "") << (rational ? ", rational" : ""));
      act(nurbs::random_surface(random, degree, 5 - degree, around_u, around_v, rational));
    }
}

// Places inside of spans of both directions.
template <class Act>
void each_inner_place(const Surface& s, double margin, const Act& act) {
  for (double v = s.v.start() + 0.0213; v < s.v.end(); v += 0.37)
    for (double u = s.u.start() + 0.0171; u < s.u.end(); u += 0.41) {
      const int a = nurbs::span_of(s.u, u), b = nurbs::span_of(s.v, v);
      if (u - margin < s.u.values[a] || u + margin > s.u.values[a + 1]) continue;
      if (v - margin < s.v.values[b] || v + margin > s.v.values[b + 1]) continue;
      act(u, v);
    }
}

}  // namespace

TEST(NurbsSurface, PointsAreSumsOfProductsOfFunctions) {  // [PT97 eq.4.11]: the definition, function by function
  each_surface(41, [](const Surface& s) {
    for (double v : nurbs::over(s.v, 7))
      for (double u : nurbs::over(s.u, 7)) {
        const double in_u = nurbs::into_domain(s.u, u), in_v = nurbs::into_domain(s.v, v);
        Vec3d sum;
        double weight = 0.0;
        for (int j = 0; j < s.v.functions(); ++j)
          for (int i = 0; i < s.u.functions(); ++i) {
            const int p = s.index(s.u.point_of(i), s.v.point_of(j));
            const double n = nurbs::basis_function(s.u, i, in_u) * nurbs::basis_function(s.v, j, in_v) * s.weight(p);
            sum += n * s.points[p], weight += n;
          }
        ASSERT_LT(length(sum / weight - nurbs::point(s, u, v)), 1e-13);
      }
  });
}

TEST(NurbsSurface, PartialDerivativesMatchDifferences) {  // [PT97 A3.6] [PT97 A4.4]
  const double h = 1e-5;
  each_surface(42, [h](const Surface& s) {
    each_inner_place(s, h, [&](double u, double v) {
      const auto at = nurbs::derivatives(s, u, v, 3);
      const auto left = nurbs::derivatives(s, u - h, v, 3), right = nurbs::derivatives(s, u + h, v, 3);
      const auto below = nurbs::derivatives(s, u, v - h, 3), above = nurbs::derivatives(s, u, v + h, 3);
      double size = 1.0;
      for (const auto& row : at)
        for (const Vec3d& d : row) size = std::max(size, length(d));
      for (int k = 0; k <= 3; ++k)
        for (int l = 0; k + l <= 3; ++l) {
          if (k > 0) {
            ASSERT_LT(length((right[k - 1][l] - left[k - 1][l]) / (2 * h) - at[k][l]), 1e-5 * size) << k << ' ' << l;
          }
          if (l > 0) {
            ASSERT_LT(length((above[k][l - 1] - below[k][l - 1]) / (2 * h) - at[k][l]), 1e-5 * size) << k << ' ' << l;
          }
        }
      const nurbs::SurfaceJet jet = nurbs::jet(s, u, v);  // [PT97 eq.4.20], the quick way
      for (const Vec3d& d : {jet.point - at[0][0], jet.du - at[1][0], jet.dv - at[0][1], jet.duu - at[2][0],
                             jet.duv - at[1][1], jet.dvv - at[0][2]})
        ASSERT_LT(length(d), 1e-11 * size);
    });
  });
}

TEST(NurbsSurface, SphereTorusCylinderAndConeAreExactWithTheirNormals) {  // [PT97 A8.1]
  const Vec3d centre{0.01, 0.02, -0.03}, axis = normalised(Vec3d{1, -2, 2});
  const double r = 0.03, tube = 0.01;
  const Surface ball = nurbs::sphere(centre, r, axis), ring = nurbs::torus(centre, axis, r, tube);
  const Surface pipe = nurbs::cylinder(centre, 0.1 * axis, r), tip = nurbs::cone(centre, 0.1 * axis, r, 0.0);
  for (const Surface* s : {&ball, &ring, &pipe, &tip}) ASSERT_EQ(nurbs::fault_in(*s), "");
  for (double u : nurbs::over(ball.u, 43))
    for (double v : nurbs::over(ball.v, 41)) {
      const Vec3d out = (nurbs::point(ball, u, v) - centre) / r;
      ASSERT_NEAR(length(out), 1, 1e-12);
      ASSERT_LT(length(nurbs::normal(ball, u, v) - out), 1e-10) << u << ' ' << v;

      const Vec3d p = nurbs::point(ring, u, v) - centre;
      const Vec3d in_plane = p - dot(p, axis) * axis, middle = r * normalised(in_plane);
      ASSERT_NEAR(length(p - middle) / tube, 1, 1e-12);
      ASSERT_LT(length(nurbs::normal(ring, u, v) - (p - middle) / tube), 1e-10);

      const Vec3d q = nurbs::point(pipe, u, v) - centre, flat = q - dot(q, axis) * axis;
      ASSERT_NEAR(length(flat) / r, 1, 1e-12);
      ASSERT_NEAR(dot(q, axis), 0.1 * v, 1e-14);
      ASSERT_LT(length(nurbs::normal(pipe, u, v) - flat / r), 1e-10);

      const Vec3d c = nurbs::point(tip, u, v) - centre, side = c - dot(c, axis) * axis;
      ASSERT_NEAR(length(side), r * (1 - v), 1e-15);
      const Vec3d n = nurbs::normal(tip, u, v);  // at the tip, too: that of the line that leads there
      ASSERT_NEAR(dot(n, axis), r / std::sqrt(r * r + 0.01), 1e-9) << u << ' ' << v;
    }
}

TEST(NurbsSurface, SphereAndTorusHaveTheirAreaVolumeAndCurvatures) {
  const double r = 0.03, tube = 0.01;
  const Surface ball = nurbs::sphere({1, 2, 3}, r), ring = nurbs::torus({1, 2, 3}, {1, 1, 0}, r, tube);
  EXPECT_NEAR(nurbs::area(ball) / (4 * portable::pi * r * r), 1, 1e-7);
  EXPECT_NEAR(nurbs::volume(ball) / (4.0 / 3 * portable::pi * r * r * r), 1, 1e-7);
  EXPECT_NEAR(nurbs::area(ring) / (4 * portable::pi * portable::pi * r * tube), 1, 1e-7);
  EXPECT_NEAR(nurbs::volume(ring) / (2 * portable::pi * portable::pi * r * tube * tube), 1, 1e-7);
  for (double u : {0.03, 0.4, 0.77}) {
    const auto of_ball = nurbs::curvatures(nurbs::jet(ball, u, 0.37));
    EXPECT_NEAR(of_ball.gauss * r * r, 1, 1e-10);
    EXPECT_NEAR(of_ball.mean * r, -1, 1e-10) << "bends away from its normal";
    const auto outside = nurbs::curvatures(nurbs::jet(ring, u, 0.0)),
               inside = nurbs::curvatures(nurbs::jet(ring, u, 0.5));
    EXPECT_NEAR(outside.gauss * tube * (r + tube), 1, 1e-10);
    EXPECT_NEAR(inside.gauss * tube * (r - tube), -1, 1e-10);
  }
}

TEST(NurbsSurface, NormalAtAPoleIsTheLimitAndNotARounding) {
  const Surface egg = nurbs::ellipsoid({0, 0, 0}, {0.03, 0, 0}, {0, 0.02, 0}, {0, 0, 0.05});
  for (double u : nurbs::over(egg.u, 29)) {
    EXPECT_LT(length(nurbs::normal(egg, u, 0.0) - Vec3d{0, 0, -1}), 1e-10) << u;
    EXPECT_LT(length(nurbs::normal(egg, u, 1.0) - Vec3d{0, 0, 1}), 1e-10) << u;
    for (double near : {1e-4, 1e-6, 1e-8, 1e-9, 1e-11, 1e-13})
      EXPECT_LT(length(nurbs::normal(egg, u, near) - Vec3d{0, 0, -1}), 20 * near + 1e-5) << u << ' ' << near;
  }
  Surface nowhere = nurbs::plane({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  nowhere.points.assign(4, {1, 1, 1});
  EXPECT_EQ(nurbs::normal(nowhere, 0.5, 0.5), Vec3d{}) << "a point has none";
}

TEST(NurbsSurface, KnotsAndDegreesInEitherDirectionLeaveTheShape) {  // [PT97 A5.3] [PT97 A5.5] [PT97 A5.10]
  each_surface(43, [](const Surface& s) {
    for (Along way : {Along::u, Along::v}) {
      EXPECT_LT(nurbs::apart(nurbs::inserted(s, way, 2.34, 2), s), kSame);
      EXPECT_LT(nurbs::apart(nurbs::refined(s, way, {1.2, 2.2, 2.2, 3.8}), s), kSame);
      EXPECT_LT(nurbs::apart(nurbs::elevated(s, way, 2), s), kSame);
      EXPECT_LT(nurbs::apart(nurbs::opened(s, way, nurbs::knots_along(s, way).start()), s), kSame);
      const auto back = nurbs::without_knot(nurbs::inserted(s, way, 2.34), way, 2.34, 1e-9);
      ASSERT_TRUE(back);
      EXPECT_LT(nurbs::apart(*back, s), 1e-11);
      EXPECT_EQ(back->points.size(), s.points.size());
      const auto lower = nurbs::reduced(nurbs::elevated(s, way), way, 1e-9);
      ASSERT_TRUE(lower);
      EXPECT_LT(nurbs::apart(*lower, s), 1e-10);
      if (nurbs::knots_along(s, way).degree > 1) {
        const double knot = nurbs::distinct(nurbs::knots_along(s, way))[2].value;
        EXPECT_FALSE(nurbs::without_knot(s, way, knot, 1e-6));
        EXPECT_FALSE(nurbs::reduced(s, way, 1e-6));
      }
    }
  });
}

TEST(NurbsSurface, PartsTransposedReversedAndMirroredAreTheSameShape) {
  each_surface(44, [](const Surface& s) {
    const Surface swapped = nurbs::transposed(s), back = nurbs::reversed(s, Along::v);
    const Surface mirror = nurbs::mirrored(s, {0.3, 0, 0}, {2, 0, 0});
    ASSERT_EQ(nurbs::fault_in(mirror), "");
    for (double v : nurbs::over(s.v, 9))
      for (double u : nurbs::over(s.u, 9)) {
        const Vec3d p = nurbs::point(s, u, v);
        ASSERT_LT(length(nurbs::point(swapped, v, u) - p), kSame);
        ASSERT_LT(length(nurbs::point(back, u, s.v.start() + s.v.end() - v) - p), kSame);
        ASSERT_LT(length(nurbs::point(mirror, s.u.start() + s.u.end() - u, v) - Vec3d{0.6 - p.x, p.y, p.z}), kSame);
      }
    for (Along way : {Along::u, Along::v}) {
      const Surface piece = nurbs::part(s, way, 1.7, 3.2);
      EXPECT_LT(nurbs::apart(piece, s), kSame);
      if (nurbs::knots_along(s, way).periodic) {
        EXPECT_REFUSED(nurbs::split(s, way, 2.0), "open it first");
        continue;
      }
      const auto [front, rear] = nurbs::split(s, way, 2.5);
      EXPECT_LT(nurbs::apart(front, s), kSame);
      EXPECT_LT(nurbs::apart(rear, s), kSame);
      EXPECT_LT(nurbs::apart(nurbs::joined(front, rear, way), s), kSame);
    }
  });
  EXPECT_REFUSED(nurbs::mirrored(nurbs::sphere({}, 1), {}, {}), "a plane's normal expected");
}

TEST(NurbsSurface, MirroredBodiesStayOutwards) {
  const Surface egg = nurbs::ellipsoid({0.1, 0, 0}, {0.03, 0, 0}, {0.01, 0.02, 0}, {0, 0, 0.05});
  const Surface mirror = nurbs::mirrored(egg, {0, 0, 0}, {1, 0, 0});
  EXPECT_NEAR(nurbs::volume(mirror) / nurbs::volume(egg), 1, 1e-12);
  EXPECT_GT(nurbs::volume(mirror), 0.0);
}

TEST(NurbsSurface, IsoCurvesLieInTheSurface) {
  each_surface(45, [](const Surface& s) {
    for (double at : {1.0, 1.9, 3.99}) {
      const nurbs::Curve along_u = nurbs::iso_curve(s, Along::u, at), along_v = nurbs::iso_curve(s, Along::v, at);
      ASSERT_EQ(nurbs::fault_in(along_u), "");
      for (double t : nurbs::over(s.u, 17)) ASSERT_LT(length(nurbs::point(along_u, t) - nurbs::point(s, t, at)), kSame);
      for (double t : nurbs::over(s.v, 17)) ASSERT_LT(length(nurbs::point(along_v, t) - nurbs::point(s, at, t)), kSame);
    }
  });
}

TEST(NurbsClosure, IsSeenOfBodiesOfEveryKind) {
  const auto of = [](const Surface& s) { return nurbs::closure_of(s); };
  EXPECT_TRUE(of(nurbs::sphere({}, 1)).like_sphere());
  EXPECT_TRUE(of(nurbs::transposed(nurbs::sphere({}, 1))).like_sphere());
  EXPECT_TRUE(of(nurbs::opened(nurbs::sphere({}, 1), Along::u, 0.2)).like_sphere()) << "clamped seam";
  EXPECT_TRUE(of(nurbs::torus({}, {0, 0, 1}, 2, 1)).like_torus());
  EXPECT_TRUE(of(nurbs::opened(nurbs::torus({}, {0, 0, 1}, 2, 1), Along::v, 0.1)).like_torus());
  const nurbs::Closure pipe = of(nurbs::cylinder({}, {0, 0, 1}, 1)), tip = of(nurbs::cone({}, {0, 0, 1}, 1, 0));
  EXPECT_TRUE(pipe.around_u);
  EXPECT_FALSE(pipe.closed() || pipe.pole_at_v[0] || pipe.pole_at_v[1]);
  EXPECT_TRUE(tip.pole_at_v[1] && !tip.pole_at_v[0]);
  EXPECT_REFUSED(nurbs::volume(nurbs::cylinder({}, {0, 0, 1}, 1)), "open are its start and its end in v");
  EXPECT_REFUSED(nurbs::volume(nurbs::cone({}, {0, 0, 1}, 1, 0)), "open are its start in v");
  EXPECT_REFUSED(nurbs::volume(nurbs::plane({}, {1, 0, 0}, {0, 1, 0})), "open are both directions");
}

TEST(NurbsClosure, NodesAreOneAtPolesAndSeams) {
  const Surface ball = nurbs::sphere({}, 1);
  const nurbs::Nodes nodes = nurbs::nodes_of(ball);
  EXPECT_EQ(ball.points.size(), 40u);
  EXPECT_EQ(nodes.count, 2 + 3 * 8);
  EXPECT_EQ(nurbs::nodes_of(nurbs::opened(ball, Along::u, 0.0)).count, nodes.count) << "its seam's points are one";
  EXPECT_EQ(nurbs::nodes_of(nurbs::transposed(ball)).count, nodes.count);
  EXPECT_EQ(nurbs::nodes_of(nurbs::torus({}, {0, 0, 1}, 2, 1)).count, 64);
  EXPECT_EQ(nurbs::nodes_of(nurbs::opened(nurbs::torus({}, {0, 0, 1}, 2, 1), Along::v, 0.25)).count, 64);
  EXPECT_EQ(nurbs::nodes_of(nurbs::plane({}, {1, 0, 0}, {0, 1, 0})).count, 4);
  // A moved pole stays a pole.
  std::vector<Vec3d> places = nurbs::places_of(nodes, ball.points);
  places[nodes.of_point[0]] += Vec3d{0, 0, -0.5};
  Surface moved = ball;
  nurbs::place(nodes, places, moved.points);
  EXPECT_TRUE(nurbs::closure_of(moved).like_sphere());
  EXPECT_LT(length(nurbs::point(moved, 0.3, 0.0) - Vec3d{0, 0, -1.5}), 1e-14);
}

TEST(NurbsClosure, OutwardsTurnsWhatIsInsideOut) {
  const Surface inside_out = nurbs::reversed(nurbs::torus({}, {0, 0, 1}, 2, 1), Along::v);
  EXPECT_LT(nurbs::volume(inside_out), 0.0);
  EXPECT_NEAR(nurbs::volume(nurbs::outwards(inside_out)) / (4 * portable::pi * portable::pi), 1, 1e-6);
}

TEST(NurbsSurface, FaultyOnesAreRefusedByName) {
  Surface bad = nurbs::sphere({}, 1);
  bad.weights[3] = -1;
  EXPECT_REFUSED(nurbs::closure_of(bad), "weight 3 above 0 expected, got -1");
  bad = nurbs::sphere({}, 1);
  bad.points[7].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_REFUSED(nurbs::inserted(bad, Along::u, 0.1), "control point 7 is not a number");
  bad = nurbs::sphere({}, 1);
  bad.v.values[4] = 2;
  EXPECT_REFUSED(nurbs::area(bad), "in v: knot 5 = 1 lies below knot 4 = 2");
  EXPECT_REFUSED(nurbs::sphere({}, 0), "sphere: a radius above 0 expected, got 0");
  EXPECT_REFUSED(nurbs::torus({}, {0, 0, 0}, 2, 1), "torus: an axis expected");
  EXPECT_REFUSED(nurbs::cone({}, {0, 0, 1}, 1, -1), "radii of at least 0");
  EXPECT_REFUSED(nurbs::ellipsoid({}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}), "three half-axes expected");
}
