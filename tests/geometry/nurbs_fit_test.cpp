#include <limits>

#include <trocar/core/hash.hpp>
#include <trocar/geometry/nurbs/closure.hpp>
#include <trocar/geometry/nurbs/mesh.hpp>
#include <trocar/geometry/nurbs/surface_edit.hpp>
#include <trocar/geometry/nurbs_fit/fit.hpp>
#include <trocar/geometry/nurbs_fit/sphere_map.hpp>
#include <trocar/geometry/nurbs_fit/square_map.hpp>
#include <trocar/geometry/nurbs_fit/surface_system.hpp>
#include <trocar/geometry/nurbs_shapes/curve_makers.hpp>
#include <trocar/geometry/nurbs_shapes/interpolate.hpp>
#include <trocar/geometry/nurbs_shapes/surface_makers.hpp>
#include <trocar/geometry/nurbs_shapes/tube.hpp>
#include <trocar/geometry/repair/rims.hpp>

#include "nurbs_cases.hpp"

using namespace trocar;
namespace nurbs = trocar::geometry::nurbs;
using geometry::TriMesh;
using nurbs::Along;
using nurbs::Surface;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Surface egg() { return nurbs::ellipsoid({0.1, 0.2, 0.3}, {0.02, 0, 0}, {0, 0.015, 0}, {0, 0, 0.04}); }
TriMesh mesh_of(const Surface& s, int steps) { return nurbs::tessellate(s, nurbs::Steps{steps, steps}).mesh; }

// A bent, thick bag with an opening: its outer and its inner side are one surface without handles, as those of hollow
// organs in atlases are.
Surface bag() {
  std::vector<Vec3d> outline{{0.0, 0, -0.03},   {0.012, 0, -0.027}, {0.02, 0, -0.01},  {0.017, 0, 0.01},
                             {0.009, 0, 0.025}, {0.007, 0, 0.026},  {0.006, 0, 0.025}, {0.014, 0, 0.009},
                             {0.017, 0, -0.01}, {0.01, 0, -0.024},  {0.0, 0, -0.027}};
  Surface s = nurbs::revolved(nurbs::curve_through(outline, 3), {}, {0, 0, 1});
  for (Vec3d& p : s.points) p.x += 8.0 * p.z * p.z;
  return s;
}
}  // namespace

TEST(NurbsSphereMap, OfASphereIsLongitudeAndLatitude) {
  const TriMesh ball = mesh_of(nurbs::sphere({}, 0.03), 8);
  const auto poles = nurbs::poles_along_longest_axis(ball);
  const int south = nurbs::nearest_vertex(ball, {0, 0, -1}), north = nurbs::nearest_vertex(ball, {0, 0, 1});
  EXPECT_NE(poles[0], poles[1]);
  const nurbs::SphereMap map = nurbs::map_to_sphere(ball, {south, north});
  EXPECT_NEAR(map.length / (portable::pi * 0.03), 1, 0.03);
  double turned = -1.0;
  for (std::size_t i = 0; i < ball.positions.size(); ++i) {
    const Vec3d p = ball.positions[i] / 0.03;
    const double latitude = 1 - portable::acos(p.z) / portable::pi;
    ASSERT_NEAR(map.v[i], latitude, 0.008) << i;
    if (std::fabs(p.z) > 0.99) continue;
    const double turn = map.u[i] - portable::atan2(p.y, p.x) / portable::two_pi;
    if (turned < 0) turned = turn - std::floor(turn);  // where u begins is the date line's choice
    const double off = turn - turned;
    ASSERT_NEAR(off, std::floor(off + 0.5), 0.02) << i;
  }
}

TEST(NurbsSphereMap, LeavesTrianglesUnfoldedHoweverABodyBends) {
  for (const Surface& body : {egg(), bag(),
                              nurbs::capped(nurbs::tube(nurbs::arc({}, {0.03, 0, 0}, {0, 0.03, 0}, 0, 4), {0.006}),
                                            nurbs::CapShape::round, nurbs::CapShape::round)}) {
    const TriMesh mesh = mesh_of(body, 4);
    const auto poles = nurbs::poles_farthest_along_edges(mesh);
    const nurbs::SphereMap map = nurbs::map_to_sphere(mesh, poles);
    int folded = 0;
    for (const auto& t : mesh.triangles) {
      if (std::find_first_of(t.begin(), t.end(), poles.begin(), poles.end()) != t.end()) continue;
      double u[3];
      for (int k = 0; k < 3; ++k) u[k] = map.u[t[k]] - std::floor(map.u[t[k]] - map.u[t[0]] + 0.5);
      const double area = (u[1] - u[0]) * (map.v[t[2]] - map.v[t[0]]) - (u[2] - u[0]) * (map.v[t[1]] - map.v[t[0]]);
      folded += area <= 0.0;
    }
    EXPECT_LT(folded, static_cast<int>(mesh.triangles.size()) / 200);
  }
}

TEST(NurbsSphereMap, RefusesOtherTopologies) {
  const TriMesh ring = mesh_of(nurbs::torus({}, {0, 0, 1}, 2, 1), 3);
  EXPECT_REFUSED(nurbs::fit_body(ring), "without handles");
  TriMesh open = mesh_of(nurbs::sphere({}, 1), 3);
  open.triangles.pop_back();
  EXPECT_REFUSED(nurbs::fit_body(open), "a closed mesh expected");
  TriMesh two = mesh_of(nurbs::sphere({}, 1), 3);
  const int n = static_cast<int>(two.positions.size());
  for (const Vec3d& p : std::vector<Vec3d>(two.positions)) two.positions.push_back(p + Vec3d{5, 0, 0});
  for (const auto& t : std::vector<std::array<int, 3>>(two.triangles))
    two.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  EXPECT_REFUSED(nurbs::fit_body(two), "in one piece");
  nurbs::BodyFitOptions few;
  few.around = 3;
  EXPECT_REFUSED(nurbs::fit_body(mesh_of(egg(), 3), few), "at least 4 control points around and 5 along");
  nurbs::BodyFitOptions same;
  same.poles = {Vec3d{}, Vec3d{}};
  EXPECT_REFUSED(nurbs::fit_body(mesh_of(egg(), 3), same), "poles that are no neighbours");
}

TEST(NurbsFit, ReturnsABodyOfItsOwnKind) {
  // A body as fits make them, with a bump, finely meshed: nothing is left over but what the mesh's triangles cut off.
  nurbs::BodyFitOptions options;
  options.around = 10, options.along = 11;
  Surface truth = nurbs::fit_body(mesh_of(egg(), 8), options).surface;
  truth.points[truth.index(3, 5)] *= 1.02;
  truth.points[truth.index(7, 4)] *= 0.99;
  options.rounds = 30;
  options.smoothing = 0.0005;
  const nurbs::Fit fit = nurbs::fit_body(mesh_of(truth, 8), options);
  EXPECT_LT(fit.report.rms, 3e-5);
  EXPECT_LT(fit.report.back_greatest, 2e-4);
  EXPECT_NEAR(fit.report.volume_of_fit / nurbs::volume(truth), 1, 3e-3);
  std::printf("returns itself: rms %.4f mm, greatest %.4f mm, volume off by %.3f %%\n", 1e3 * fit.report.rms,
              1e3 * fit.report.greatest, 100 * (fit.report.volume_of_fit / nurbs::volume(truth) - 1));
}

TEST(NurbsFit, OfAnEllipsoidComesToItWithMoreControlPoints) {
  const TriMesh mesh = mesh_of(egg(), 12);
  double last = 1.0;
  for (int n : {6, 10, 16}) {
    nurbs::BodyFitOptions options;
    options.around = n, options.along = n + 2;
    const nurbs::Fit fit = nurbs::fit_body(mesh, options);
    EXPECT_TRUE(nurbs::closure_of(fit.surface).like_sphere());
    if (n < 16) {
      EXPECT_LT(fit.report.rms, 0.5 * last) << n;
      last = fit.report.rms;
      continue;
    }
    // From here on vertices are outside by what the mesh's triangles cut off: 0.04 mm where it is widest.
    EXPECT_LT(fit.report.rms, 5e-5) << "a twentieth of a millimetre of 80";
    EXPECT_NEAR(fit.report.volume_of_fit / fit.report.volume_of_mesh, 1, 2e-3);
    EXPECT_NEAR(fit.report.volume_of_mesh, geometry::volume(mesh), 1e-15);
  }
}

TEST(NurbsFit, HasATangentPlaneAtItsPoles) {
  const nurbs::Fit fit = nurbs::fit_body(mesh_of(bag(), 5));
  for (double v : {0.0, 1.0}) {
    const Vec3d n = nurbs::normal(fit.surface, 0.0, v);
    for (double u : nurbs::over(fit.surface.u, 23)) {
      EXPECT_GT(dot(nurbs::normal(fit.surface, u, v), n), 1 - 1e-9) << u << ' ' << v;
      const double near = v == 0.0 ? 1e-5 : 1 - 1e-5;
      EXPECT_GT(dot(nurbs::normal(fit.surface, u, near), n), 0.999) << u << ' ' << v;
    }
  }
}

TEST(NurbsFit, OfABentBagWithAnInnerSideIsWithinASmallShareOfItsWall) {
  const TriMesh mesh = mesh_of(bag(), 5);
  nurbs::BodyFitOptions options;
  options.around = 14, options.along = 26;
  const nurbs::Fit fit = nurbs::fit_body(mesh, options);
  EXPECT_LT(fit.report.rms, 2e-4) << "of a wall 3 mm thick";
  EXPECT_LT(fit.report.back_rms, 1.5e-4);
  EXPECT_NEAR(fit.report.volume_of_fit / fit.report.volume_of_mesh, 1, 0.02);
  std::printf("bag: rms %.4f mm, greatest %.4f mm, back %.4f and %.4f mm, volume off by %.3f %%\n",
              1e3 * fit.report.rms, 1e3 * fit.report.greatest, 1e3 * fit.report.back_rms,
              1e3 * fit.report.back_greatest, 100 * (fit.report.volume_of_fit / fit.report.volume_of_mesh - 1));
}

TEST(NurbsFit, FacesOutwardsWhicheverWayItsMeshIsTurnedAndTwiceMakesTheSameBits) {
  const TriMesh mesh = mesh_of(egg(), 4);
  TriMesh turned = mesh;
  for (auto& t : turned.triangles) std::swap(t[1], t[2]);
  const nurbs::Fit once = nurbs::fit_body(mesh), again = nurbs::fit_body(mesh), other = nurbs::fit_body(turned);
  EXPECT_GT(nurbs::volume(once.surface), 0.0);
  EXPECT_GT(nurbs::volume(other.surface), 0.0);
  EXPECT_GT(other.report.volume_of_mesh, 0.0);
  EXPECT_EQ(once.surface.points, again.surface.points);
}

// The value was printed once by gcc 12 on x86-64; every other compiler and machine must find the same.
TEST(NurbsFit, GivesTheSameBitsOnEveryCompiler) {
  const nurbs::Fit fit = nurbs::fit_body(mesh_of(bag(), 3));
  const TriMesh tube = nurbs::tessellate(nurbs::tube(nurbs::circle({}, {1, 2, 3}, 0.03), {0.004}), 1e-4).mesh;
  core::Hasher hasher;
  hasher.add(fit.surface.points);
  hasher.add(fit.report.residuals);
  hasher.add(tube.positions);
  hasher.add(tube.triangles);
  EXPECT_EQ(hasher.value(), 0x959be54e28fe94d2ull) << std::hex << hasher.value();
}

TEST(NurbsFit, OfACloudAllAroundIsTheBodyThatItIsOf) {
  const TriMesh mesh = mesh_of(egg(), 9);
  nurbs::BodyFitOptions options;
  options.around = 12, options.along = 12;
  const nurbs::Fit fit = nurbs::fit_body(std::span<const Vec3d>(mesh.positions), options);
  EXPECT_LT(fit.report.rms, 1e-4);
  EXPECT_NEAR(fit.report.volume_of_fit / nurbs::volume(egg()), 1, 0.01);
  std::vector<Vec3d> bad = mesh.positions;
  bad[5].x = kNan;
  EXPECT_REFUSED(nurbs::fit_body(std::span<const Vec3d>(bad)), "point 5 is not a number");
  bad.resize(4);
  EXPECT_REFUSED(nurbs::fit_body(std::span<const Vec3d>(bad)), "at least 16 points expected, got 4");
}

TEST(NurbsSquareMap, LaysTheRimOnTheEdgesAndFoldsNothing) {
  const nurbs::SurfaceMesh sheet = nurbs::tessellate(nurbs::part(egg(), Along::v, 0.3, 0.7), nurbs::Steps{6, 9});
  const TriMesh half =
      nurbs::tessellate(nurbs::part(nurbs::part(egg(), Along::v, 0.3, 0.7), Along::u, 0.1, 0.5), nurbs::Steps{6, 9})
          .mesh;
  EXPECT_REFUSED(nurbs::map_to_square(sheet.mesh), "one rim expected, got 2");
  TriMesh turned = half;
  std::swap(turned.triangles[3][0], turned.triangles[3][1]);
  EXPECT_REFUSED(nurbs::map_to_square(turned), "turned against each other");
  const nurbs::SquareMap map = nurbs::map_to_square(half);
  int on_edge = 0;
  for (const auto& [u, v] : map.parameters) {
    ASSERT_TRUE(u >= 0 && u <= 1 && v >= 0 && v <= 1);
    on_edge += u == 0 || u == 1 || v == 0 || v == 1;
  }
  EXPECT_EQ(on_edge, static_cast<int>(geometry::rims_of(half, geometry::EdgeTable(half))[0].vertices.size()));
  for (const auto& t : half.triangles) {
    const auto &a = map.parameters[t[0]], &b = map.parameters[t[1]], &c = map.parameters[t[2]];
    ASSERT_GT((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]), 0.0);
  }
}

TEST(NurbsSquareMap, FindsTheCornersOfARectangleFromEitherSide) {
  TriMesh sheet = nurbs::tessellate(nurbs::plane({1, 2, 3}, {2, 0, 0}, {0, 0.6, 0.8}), nurbs::Steps{9, 5}).mesh;
  for (int side = 0; side < 2; ++side) {
    const nurbs::SquareMap map = nurbs::map_to_square(sheet);
    EXPECT_NEAR(map.way_u * map.way_v, 2.0, 1e-12);
    int corners = 0;
    for (std::size_t i = 0; i < sheet.positions.size(); ++i) {
      const Vec3d p = sheet.positions[i] - Vec3d{1, 2, 3};
      const bool corner = (p.x < 1e-9 || p.x > 2 - 1e-9) && (p.z < 1e-9 || p.z > 0.8 - 1e-9);
      const auto& [u, v] = map.parameters[i];
      EXPECT_TRUE(!corner || ((u == 0 || u == 1) && (v == 0 || v == 1))) << u << ' ' << v;
      corners += corner;
    }
    EXPECT_EQ(corners, 4);
    for (auto& t : sheet.triangles) std::swap(t[1], t[2]);
  }
}

TEST(NurbsFit, OfAPatchIsWithinASmallShareOfItsSize) {
  const Surface sheet = nurbs::part(nurbs::part(egg(), Along::v, 0.3, 0.7), Along::u, 0.1, 0.5);
  const TriMesh mesh = nurbs::tessellate(sheet, nurbs::Steps{8, 12}).mesh;
  const nurbs::Fit fit = nurbs::fit_patch(mesh);
  EXPECT_LT(fit.report.rms, 1e-4);
  EXPECT_LT(fit.report.greatest, 3e-4);
  EXPECT_LT(fit.report.back_greatest, 8e-4) << "it ends where the mesh does";
  TriMesh turned = mesh;
  for (auto& t : turned.triangles) std::swap(t[1], t[2]);
  EXPECT_GT(dot(nurbs::normal(fit.surface, 0.5, 0.5), geometry::area_vector(mesh, 0)), 0.0) << "faces as the mesh";
  EXPECT_GT(dot(nurbs::normal(nurbs::fit_patch(turned).surface, 0.5, 0.5), geometry::area_vector(turned, 0)), 0.0);
  const nurbs::Fit cloud = nurbs::fit_patch(std::span<const Vec3d>(mesh.positions));
  EXPECT_LT(cloud.report.rms, 1e-4);
  std::printf("patch: rms %.4f mm, greatest %.4f mm; cloud %.4f and %.4f mm\n", 1e3 * fit.report.rms,
              1e3 * fit.report.greatest, 1e3 * cloud.report.rms, 1e3 * cloud.report.greatest);
  EXPECT_REFUSED(nurbs::fit_patch(mesh, {3, 8}), "at least 4 control points each way");
  EXPECT_REFUSED(nurbs::fit_patch(mesh_of(egg(), 3)), "one rim expected, got 0");
  EXPECT_REFUSED(nurbs::fit_patch(std::vector<Vec3d>(20, Vec3d{1, 2, 3})), "do not all lie on a line");
}

TEST(NurbsSurfaceSystem, ReturnsTheSurfaceThatItsPointsAreOf) {
  core::Random random(82);
  Surface truth{nurbs::clamped_uniform(3, 7), nurbs::clamped_uniform(3, 6), {}, {}};
  for (int i = 0; i < 42; ++i) truth.points.push_back(nurbs::random_place(random));
  const nurbs::Unknowns unknowns = nurbs::free_unknowns(truth.u, truth.v);
  nurbs::SurfaceSystem system(unknowns);
  for (double v : nurbs::over(truth.v, 15))
    for (double u : nurbs::over(truth.u, 15)) system.add_point(u, v, nurbs::point(truth, u, v), 1.0 / 225);
  EXPECT_LT(nurbs::apart(system.solve(), truth), 1e-11);
  nurbs::SurfaceSystem empty(unknowns);
  EXPECT_THROW(empty.solve(), std::runtime_error);
}

// A sheet that is held in a row of points at either side and bent by its stiffness alone stays flat between.
TEST(NurbsSurfaceSystem, StiffnessFillsGapsStraight) {
  const nurbs::Unknowns unknowns = nurbs::free_unknowns(nurbs::clamped_uniform(3, 9), nurbs::clamped_uniform(3, 5));
  nurbs::SurfaceSystem system(unknowns);
  for (double v : {0.0, 0.3, 0.7, 1.0})
    for (double u : {0.0, 0.1, 0.9, 1.0}) system.add_point(u, v, {u, v, 0.5 * u - v}, 1.0 / 16);
  system.add_bending(0.1, 1.0, 1.0);
  const Surface s = system.solve();
  for (double v : nurbs::over(s.v, 9))
    for (double u : nurbs::over(s.u, 9)) ASSERT_LT(length(nurbs::point(s, u, v) - Vec3d{u, v, 0.5 * u - v}), 1e-9);
}
