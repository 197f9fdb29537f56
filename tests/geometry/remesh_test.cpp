// Meshes that are changed edge by edge, smoothed, thinned out and made even.
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/geometry/remesh/editable.hpp>
#include <trocar/geometry/remesh/remeshed.hpp>
#include <trocar/geometry/remesh/simplified.hpp>
#include <trocar/geometry/remesh/smoothed.hpp>
#include <trocar/geometry/repair/examine.hpp>

#include "broken_meshes.hpp"

namespace trocar::geometry {
namespace {

/// Rough as a scan: radii off by up to a share.
TriMesh rough_ball(double radius, int levels, double share) {
  core::Random random(3);
  TriMesh mesh = sphere_mesh(radius, levels);
  for (Vec3d& p : mesh.positions) p *= 1 + random.uniform(-share, share);
  return mesh;
}
double roughness(const TriMesh& mesh) {
  double sum = 0;
  const std::vector<Vec3d> normals = vertex_normals(mesh);
  for (std::size_t v = 0; v < normals.size(); ++v) sum += 1 - dot(normals[v], normalised(mesh.positions[v]));
  return sum / double(normals.size());
}

}  // namespace

TEST(EditableMesh, SplitsFlipsAndCollapsesKeepAClosedManifold) {
  core::Random random(8);
  EditableMesh work(sphere_mesh(1, 2));
  int splits = 0, flips = 0, collapses = 0;
  for (int step = 0; step < 4000; ++step) {
    const int f = int(random.uniform() * work.faces());
    if (!work.alive(f)) continue;
    const int k = int(random.uniform() * 3), a = work.face(f)[k], b = work.face(f)[(k + 1) % 3];
    const double what = random.uniform();
    if (what < 0.3 && ++splits)
      work.split(a, b, 0.5 * (work.place(a) + work.place(b)));
    else if (what < 0.6 && work.can_flip(a, b) && ++flips)
      work.flip(a, b);
    else if (what >= 0.6 && work.can_collapse(a, b) && ++collapses)
      work.collapse(a, b);
  }
  EXPECT_TRUE(splits > 300 && flips > 300 && collapses > 300);
  const TriMesh mesh = work.taken();
  EXPECT_EQ(int(mesh.triangles.size()), work.living_faces());
  const Diagnosis d = examine(mesh, {0, 1, false});
  EXPECT_TRUE(check_edges(mesh).closed());
  EXPECT_TRUE(d.pinched_vertices.empty() && d.duplicate_triangles.empty() &&
              d.degenerate.size() < mesh.triangles.size());
  EXPECT_EQ(int(mesh.positions.size()) - int(edges(mesh).size()) + int(mesh.triangles.size()), 2) << "still a ball";
}

TEST(EditableMesh, ATetrahedronCannotCollapseAndATubeKeepsItsHoles) {
  const TriMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  EditableMesh small(tetrahedron);
  EXPECT_FALSE(small.can_collapse(0, 1));
  EXPECT_FALSE(small.can_flip(0, 1)) << "its other diagonal is an edge already";
  EditableMesh tube(open_tube(1, 1, 3, 1));
  EXPECT_FALSE(tube.can_collapse(0, 3)) << "would join the two borders";
  EXPECT_FALSE(tube.can_collapse(0, 1)) << "would close the border of three edges";
}

TEST(Smoothed, NoiseGoesAndTheVolumeStays) {
  const TriMesh rough = rough_ball(0.03, 4, 0.03);
  const Smoothed smooth = smoothed(rough, 10);
  EXPECT_LT(roughness(smooth.mesh), 0.2 * roughness(rough));
  EXPECT_NEAR(smooth.volume, smooth.volume_before, 1e-9 * smooth.volume_before);
  EXPECT_DOUBLE_EQ(smooth.volume_before, volume(rough));
  EXPECT_GT(smooth.farthest, 0);
  EXPECT_LT(smooth.farthest, 0.002);
  SmoothOptions shrinking;
  shrinking.swell = 0;
  shrinking.keep_volume = false;
  EXPECT_LT(smoothed(rough, 50, shrinking).volume, 0.8 * volume(rough)) << "what others do";
}

TEST(Smoothed, BordersStayAndNoPassChangesNothing) {
  const TriMesh tube = open_tube(0.01, 0.05, 24, 10);
  const Smoothed smooth = smoothed(tube, 5);
  for (int i = 0; i < 24; ++i) EXPECT_EQ(smooth.mesh.positions[i], tube.positions[i]);
  EXPECT_EQ(smoothed(tube, 0).mesh.positions, tube.positions);
}

TEST(Simplified, ABallKeepsItsShapeWithATenthOfItsTriangles) {
  const TriMesh ball = sphere_mesh(0.03, 5);
  const Simplified small = simplified(ball, int(ball.triangles.size()) / 10);
  EXPECT_LE(small.mesh.triangles.size(), ball.triangles.size() / 10);
  EXPECT_GT(small.mesh.triangles.size(), ball.triangles.size() / 11);
  const Diagnosis d = examine(small.mesh);
  EXPECT_TRUE(d.is_body()) << in_words(d);
  EXPECT_NEAR(small.volume, small.volume_before, 0.006 * small.volume_before);
  for (const Vec3d& p : small.mesh.positions) EXPECT_NEAR(length(p), 0.03, 0.0003);
  EXPECT_GT(small.error, 0);
}

TEST(Simplified, FlatFacesCostNothingAndEdgesStaySharp) {
  TriMesh fine = remeshed(box_mesh({1, 1, 1}), 0.1).mesh;
  ASSERT_GT(fine.triangles.size(), 1000u);
  SimplifyOptions exact;
  exact.most_error = 1e-5;
  const Simplified box = simplified(fine, 0, exact);
  EXPECT_LE(box.mesh.triangles.size(), 30u);
  EXPECT_NEAR(box.volume, 1, 1e-9);
  EXPECT_TRUE(examine(box.mesh).is_body());
}

TEST(Simplified, BordersKeepTheirLineAndHolesStay) {
  const TriMesh tube = open_tube(0.01, 0.05, 32, 40);
  const Simplified small = simplified(tube, 400);
  const Diagnosis d = examine(small.mesh);
  ASSERT_EQ(d.holes.size(), 2u);
  for (const Rim& rim : d.holes)
    for (const int v : rim.vertices) {
      const double z = small.mesh.positions[v].z;
      EXPECT_LT(std::min(std::fabs(z), std::fabs(z - 0.05)), 1e-6);
    }
  EXPECT_LE(small.mesh.triangles.size(), 400u);
  EXPECT_TRUE(d.crossings.empty());
}

TEST(Simplified, AsFewAsCanBeIsStillClosed) {
  const Simplified least = simplified(sphere_mesh(1, 3), 0);
  EXPECT_TRUE(check_edges(least.mesh).closed());
  EXPECT_LT(least.mesh.triangles.size(), 40u);
  EXPECT_GE(least.mesh.triangles.size(), 4u);
}

TEST(Remeshed, EdgesAreOfTheWantedLengthAndAnglesWide) {
  TriMesh uneven = sphere_mesh(0.03, 4);
  for (Vec3d& p : uneven.positions) p.x *= 2;
  for (const double edge : {0.002, 0.005}) {
    const Remeshed even = remeshed(uneven, edge);
    const Diagnosis d = examine(even.mesh);
    EXPECT_TRUE(d.is_body());
    EXPECT_NEAR(even.mean_edge, edge, 0.15 * edge);
    EXPECT_GT(even.least_angle, 20) << edge;
    EXPECT_NEAR(even.volume, even.volume_before, 0.02 * even.volume_before);
    EXPECT_LT(even.farthest, 0.1 * edge);
    EXPECT_DOUBLE_EQ(even.least_angle, d.least_angle);
  }
}

TEST(Remeshed, SharpEdgesAndCornersStay) {
  const Remeshed fine = remeshed(box_mesh({0.1, 0.06, 0.04}), 0.007);
  EXPECT_TRUE(examine(fine.mesh).is_body());
  EXPECT_NEAR(fine.volume, 0.1 * 0.06 * 0.04, 1e-12);
  EXPECT_LT(fine.farthest, 1e-9);
  for (const Vec3d& corner : box_mesh({0.1, 0.06, 0.04}).positions)
    EXPECT_NE(std::find(fine.mesh.positions.begin(), fine.mesh.positions.end(), corner), fine.mesh.positions.end());
  RemeshOptions round;
  round.sharp_deg = 180;
  EXPECT_LT(remeshed(box_mesh({0.1, 0.06, 0.04}), 0.007, round).volume, 0.999 * fine.volume);
}

TEST(Remeshed, ASheetKeepsItsBorder) {
  const TriMesh tube = open_tube(0.01, 0.05, 24, 10);
  const Remeshed even = remeshed(tube, 0.002);
  const Diagnosis d = examine(even.mesh);
  ASSERT_EQ(d.holes.size(), 2u);
  for (const Rim& rim : d.holes) EXPECT_NEAR(rim.length, 24 * 2 * 0.01 * std::sin(3.14159265358979 / 24), 1e-9);
  EXPECT_GT(even.least_angle, 15);
}

TEST(Remeshed, RefusesWhatIsTooFineOrNoLength) {
  const TriMesh ball = sphere_mesh(0.03, 2);
  EXPECT_THROW(remeshed(ball, 0), std::invalid_argument);
  EXPECT_THROW(remeshed(ball, -1), std::invalid_argument);
  EXPECT_THROW(remeshed(ball, 1e-6), std::invalid_argument);
  const TriMesh needle{{{0, 0, 0}, {1e6, 0, 0}, {1e6, 1e-9, 0}}, {{0, 1, 2}}};
  RemeshOptions few;
  few.most_triangles = 10'000;
  EXPECT_THROW(remeshed(needle, 1e-4, few), std::invalid_argument);
  EXPECT_TRUE(remeshed({}, 1).mesh.triangles.empty());
}

}  // namespace trocar::geometry
