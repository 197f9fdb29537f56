#include <trocar/geometry/nurbs/closest.hpp>
#include <trocar/geometry/nurbs/mesh.hpp>
#include <trocar/geometry/nurbs/surface_edit.hpp>
#include <trocar/geometry/nurbs/weights.hpp>
#include <trocar/geometry/nurbs_shapes/curve_makers.hpp>
#include <trocar/geometry/nurbs_shapes/surface_makers.hpp>
#include <trocar/geometry/nurbs_shapes/tube.hpp>
#include <trocar/geometry/volumes/field.hpp>

#include "nurbs_cases.hpp"

using namespace trocar;
namespace nurbs = trocar::geometry::nurbs;
using geometry::TriMesh;
using nurbs::Along;
using nurbs::Surface;

namespace {

int euler(const TriMesh& mesh) {
  return static_cast<int>(mesh.positions.size()) - geometry::check_edges(mesh).edges +
         static_cast<int>(mesh.triangles.size());
}
std::vector<Surface> bodies() {
  const Surface ball = nurbs::sphere({0.1, 0.2, 0.3}, 0.03), ring = nurbs::torus({}, {1, 0, 1}, 0.03, 0.01);
  const Surface pipe = nurbs::cylinder({}, {0, 0, 0.1}, 0.02);
  return {ball,
          ring,
          nurbs::transposed(ball),
          nurbs::reversed(ball, Along::v),
          nurbs::opened(ball, Along::u, 0.3),
          nurbs::opened(ring, Along::v, 0.2),
          nurbs::capped(pipe, nurbs::CapShape::flat, nurbs::CapShape::round)};
}
// Farthest from the mesh of many points of the surface.
double off_mesh(const Surface& s, const TriMesh& mesh) {
  const auto distance = geometry::distance_to(mesh);
  double worst = 0.0;
  for (double v : nurbs::over(s.v, 53))
    for (double u : nurbs::over(s.u, 59)) worst = std::max(worst, distance(nurbs::point(s, u, v)));
  return worst;
}

}  // namespace

TEST(NurbsGrid, IsTheSurfaceAndItsNormalsHoweverItsControlPointsMove) {
  core::Random random(61);
  for (int kind = 0; kind < 8; ++kind) {
    Surface s = nurbs::random_surface(random, 3, 2, kind & 1, kind & 2, kind & 4);
    const std::vector<double> us = nurbs::over(s.u, 23), vs = nurbs::over(s.v, 19);
    nurbs::GridEvaluator grid(s, us, vs);
    std::vector<Vec3d> positions(us.size() * vs.size()), normals(positions.size());
    for (int round = 0; round < 3; ++round) {
      for (Vec3d& p : s.points) p += 0.1 * nurbs::random_place(random);
      grid.evaluate(s.points, positions, normals);
      for (std::size_t j = 0; j < vs.size(); ++j)
        for (std::size_t i = 0; i < us.size(); ++i) {
          ASSERT_LT(length(positions[i + us.size() * j] - nurbs::point(s, us[i], vs[j])), 1e-13) << kind;
          ASSERT_LT(length(normals[i + us.size() * j] - nurbs::normal(s, us[i], vs[j])), 1e-9) << kind;
        }
    }
    std::vector<Vec3d> alone(positions.size());
    grid.evaluate(s.points, alone, {});
    EXPECT_EQ(alone, positions);
  }
}

TEST(NurbsGrid, HasTheNormalAtPoles) {
  Surface ball = nurbs::sphere({}, 2);
  const std::vector<double> us = nurbs::over(ball.u, 9), vs{0.0, 0.5, 1.0};
  nurbs::GridEvaluator grid(ball, us, vs);
  std::vector<Vec3d> positions(27), normals(27);
  for (Vec3d& p : ball.points)
    p = Vec3d{p.z, p.x, p.y} + Vec3d{0.1, 0.2, 0.3};  // turned: not the points that it was made with
  grid.evaluate(ball.points, positions, normals);
  for (int i = 0; i < 9; ++i) {
    EXPECT_LT(length(normals[i] - Vec3d{-1, 0, 0}), 1e-10);
    EXPECT_LT(length(normals[18 + i] - Vec3d{1, 0, 0}), 1e-10);
  }
}

TEST(NurbsMesh, OfClosedBodiesIsClosedOutwardsAndOfOnePiece) {
  for (const Surface& body : bodies())
    for (int steps : {1, 2, 5}) {
      const nurbs::SurfaceMesh made = nurbs::tessellate(body, nurbs::Steps{steps, steps + 1});
      ASSERT_TRUE(geometry::check_edges(made.mesh).closed());
      ASSERT_GT(geometry::volume(made.mesh), 0.0);
      ASSERT_EQ(euler(made.mesh), nurbs::closure_of(body).like_torus() ? 0 : 2);
      ASSERT_EQ(made.normals.size(), made.mesh.positions.size());
      const auto flat = geometry::vertex_normals(made.mesh);
      for (std::size_t i = 0; i < flat.size(); ++i) {
        ASSERT_LT(length(nurbs::point(body, made.parameters[i][0], made.parameters[i][1]) - made.mesh.positions[i]),
                  1e-15);
        const Vec3d p = made.mesh.positions[i];
        const bool on_rim = std::fabs(p.z) < 1e-12 && length(p) > 0.019 && length(p) < 0.021;  // of the flat lid
        if (steps == 5 && !on_rim) {
          ASSERT_GT(dot(flat[i], made.normals[i]), 0.95) << "outwards";
        }
      }
      const auto used = geometry::vertex_triangles(made.mesh);
      for (int v = 0; v < used.rows(); ++v) ASSERT_GT(used.row(v).size(), 2u) << "a vertex that nothing uses";
    }
}

TEST(NurbsMesh, VolumeComesToTheBodysWithTheSquareOfTheSteps) {
  const double r = 0.03;
  for (const Surface& body : {nurbs::sphere({}, r), nurbs::torus({}, {0, 0, 1}, r, 0.4 * r)}) {
    const double truth = nurbs::closure_of(body).like_torus() ? 2 * portable::pi * portable::pi * r * 0.16 * r * r
                                                              : 4.0 / 3 * portable::pi * r * r * r;
    double last = 0.0;
    for (int steps : {4, 8, 16, 32}) {
      const double short_of = truth - geometry::volume(nurbs::tessellate(body, nurbs::Steps{steps, steps}).mesh);
      EXPECT_GT(short_of, 0.0) << steps;
      if (last > 0.0) {
        EXPECT_NEAR(last / short_of, 4, 0.1) << steps;
      }
      last = short_of;
    }
    EXPECT_LT(last / truth, 2e-3);
  }
}

TEST(NurbsMesh, IsWithinItsToleranceAndFinerOnesHaveMoreTriangles) {
  core::Random random(62);
  std::vector<Surface> all{nurbs::sphere({}, 0.03), nurbs::torus({}, {0, 0, 1}, 0.03, 0.01)};
  all.push_back(nurbs::random_surface(random, 3, 2, true, false, true));
  for (const Surface& s : all) {
    std::size_t last = 0;
    for (double tolerance : {3e-3, 5e-4}) {
      const bool large = s.points.size() == all.back().points.size();
      const nurbs::SurfaceMesh made = nurbs::tessellate(s, large ? 20 * tolerance : tolerance);
      EXPECT_LE(off_mesh(s, made.mesh), large ? 20 * tolerance : tolerance);
      EXPECT_GT(made.mesh.triangles.size(), last);
      last = made.mesh.triangles.size();
    }
    EXPECT_LT(last, 30000u) << "not finer than it must be";
  }
  EXPECT_EQ(nurbs::tessellate(nurbs::plane({}, {1, 0, 0}, {0, 1, 0}), 1e-9).mesh.triangles.size(), 2u);
}

TEST(NurbsMesh, OfAnOpenSheetFacesAlongItsNormal) {
  const nurbs::SurfaceMesh made = nurbs::tessellate(nurbs::plane({}, {1, 0, 0}, {0, 1, 0}), nurbs::Steps{3, 2});
  EXPECT_EQ(made.mesh.triangles.size(), 12u);
  for (int t = 0; t < 12; ++t) EXPECT_GT(geometry::area_vector(made.mesh, t).z, 0.0);
}

TEST(NurbsMesh, MovesWithItsControlPoints) {
  for (const Surface& body : bodies()) {
    const nurbs::SurfaceMesh made = nurbs::tessellate(body, nurbs::Steps{3, 3});
    nurbs::MovingMesh moving(body, made);
    Surface moved = body;
    for (Vec3d& p : moved.points) p = {1.5 * p.x + 0.2 * p.y, p.y, 0.7 * p.z};
    std::vector<Vec3d> positions(made.mesh.positions.size()), normals(positions.size());
    moving.move(moved.points, positions, normals);
    const nurbs::SurfaceMesh anew = nurbs::tessellate(moved, nurbs::Steps{3, 3});
    for (std::size_t i = 0; i < positions.size(); ++i) {
      ASSERT_LT(length(positions[i] - anew.mesh.positions[i]), 1e-15);
      ASSERT_LT(length(normals[i] - anew.normals[i]), 1e-12);
    }
  }
}

TEST(NurbsMesh, RefusesWhatCannotBeMeshed) {
  const Surface ball = nurbs::sphere({}, 1);
  EXPECT_REFUSED(nurbs::tessellate(ball, nurbs::Steps{0, 3}), "at least one step");
  EXPECT_REFUSED(nurbs::tessellate(ball, 0.0), "a tolerance above 0");
  EXPECT_REFUSED(nurbs::tessellate(ball, {0, 0.5, 1}, {0, 0.5, 1}), "at least 3 steps");
  EXPECT_REFUSED(nurbs::tessellate(ball, {0, 0.5, 0.2, 1}, {0, 0.5, 0.7, 1}), "ascending parameters");
  EXPECT_REFUSED(nurbs::tessellate(ball, nurbs::Steps{5000, 5000}), "more than 20000000 vertices");
}

TEST(NurbsWeights, RowsSumToOneAndGiveTheSurface) {  // [PT97 eq.4.12]
  core::Random random(63);
  for (int kind = 0; kind < 8; ++kind) {
    const Surface s = nurbs::random_surface(random, 3, 2, kind & 1, kind & 2, kind & 4);
    const nurbs::Nodes nodes = nurbs::nodes_of(s);
    const std::vector<Vec3d> places = nurbs::places_of(nodes, s.points);
    for (double v : nurbs::over(s.v, 11))
      for (double u : nurbs::over(s.u, 11)) {
        const auto row = nurbs::weights_at(s, u, v), by_node = nurbs::node_weights_at(s, nodes, u, v);
        ASSERT_EQ(row.size(), 12u) << "no others have a share";
        double sum = 0.0;
        for (const nurbs::Share& share : row) {
          ASSERT_GE(share.value, 0.0);
          sum += share.value;
        }
        ASSERT_NEAR(sum, 1, 1e-14);
        ASSERT_LT(length(nurbs::combined(row, s.points) - nurbs::point(s, u, v)), 1e-13);
        ASSERT_LT(length(nurbs::combined(by_node, places) - nurbs::point(s, u, v)), 1e-13);
      }
  }
}

TEST(NurbsWeights, APolesPointHangsOnItsOneNode) {
  const Surface ball = nurbs::sphere({}, 1);
  const nurbs::Nodes nodes = nurbs::nodes_of(ball);
  const std::vector<std::array<double, 2>> at{{0.3, 0.0}, {0.3, 0.4}, {0.9, 1.0}};
  const nurbs::WeightRows rows = nurbs::weight_rows(ball, nodes, at);
  ASSERT_EQ(rows.nodes.rows(), 3);
  ASSERT_EQ(rows.nodes.row(0).size(), 1u);
  EXPECT_EQ(rows.nodes.row(0)[0], nodes.of_point[0]);
  EXPECT_NEAR(rows.values[0], 1.0, 1e-15);
  EXPECT_EQ(rows.nodes.row(1).size(), 7u) << "the pole once, and two rings of three";
  EXPECT_EQ(rows.nodes.row(2)[0], nodes.of_point.back());
  const std::vector<Vec3d> places = nurbs::places_of(nodes, ball.points);
  Vec3d x;
  for (std::size_t k = 0; k < rows.nodes.row(1).size(); ++k)
    x += rows.values[rows.nodes.start[1] + k] * places[rows.nodes.row(1)[k]];
  EXPECT_LT(length(x - nurbs::point(ball, 0.3, 0.4)), 1e-15);
}

// What W is for: forces go back to the masses by its transpose without changing their sum or their moment.
TEST(NurbsWeights, ForcesGoBackWithTheirSumAndMoment) {
  const Surface ring = nurbs::torus({}, {0, 0, 1}, 2, 1);
  const nurbs::Nodes nodes = nurbs::nodes_of(ring);
  const std::vector<Vec3d> places = nurbs::places_of(nodes, ring.points);
  const Vec3d force{1, -2, 3};
  const auto row = nurbs::node_weights_at(ring, nodes, 0.21, 0.83);
  Vec3d sum, moment;
  for (const nurbs::Share& share : row) {
    sum += share.value * force;
    moment += cross(places[share.index], share.value * force);
  }
  EXPECT_LT(length(sum - force), 1e-14);
  EXPECT_LT(length(moment - cross(nurbs::point(ring, 0.21, 0.83), force)), 1e-13);
}
