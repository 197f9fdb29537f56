// Each fault by itself, found where it is; and the simple repairs of it.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/geometry/repair/cleaned.hpp>
#include <trocar/geometry/repair/examine.hpp>

#include "broken_meshes.hpp"

namespace trocar::geometry {
namespace {

/// What is found, by name of the repair.
std::vector<std::string> remedies(const TriMesh& mesh) {
  std::vector<std::string> out;
  for (const Finding& f : findings(examine(mesh))) out.emplace_back(f.remedy);
  return out;
}
using Names = std::vector<std::string>;
using Places = std::vector<int>;
using Edges = std::vector<std::array<int, 2>>;

}  // namespace

TEST(Examine, ASoundBodyHasNothingToMend) {
  for (const TriMesh& mesh : {box_mesh({0.1, 0.2, 0.3}), sphere_mesh(0.03, 3)}) {
    const Diagnosis d = examine(mesh);
    EXPECT_TRUE(d.is_body());
    EXPECT_TRUE(findings(d).empty());
    EXPECT_DOUBLE_EQ(d.volume, volume(mesh));
    EXPECT_DOUBLE_EQ(d.area, area(mesh));
    EXPECT_EQ(d.shells.list.size(), 1u);
  }
  EXPECT_EQ(in_words(examine(box_mesh({0.1, 0.2, 0.3}))),
            "8 vertices, 12 triangles, 100 x 200 x 300 mm, 2200 cm2, 6000 ml: a body\n");
  EXPECT_NEAR(examine(box_mesh({1, 1, 1})).least_angle, 45, 1e-9);
}

TEST(Examine, NothingIsNoBody) {
  EXPECT_FALSE(examine({}).is_body());
  EXPECT_EQ(in_words(examine({})), "0 vertices, 0 triangles\n");
}

TEST(Examine, PlacesThatAreNoNumbersAreFoundAndAllElseIsLookedAt) {
  TriMesh mesh = together(box_mesh({1, 1, 1}), sphere_mesh(0.2, 1));
  mesh.positions[9].y = std::nan("");
  mesh.positions[10].z = 1e300;
  mesh.positions.push_back({INFINITY, 0, 0});
  const Diagnosis d = examine(mesh);
  EXPECT_EQ(d.not_finite, (Places{9, 10, 26}));
  EXPECT_TRUE(std::isfinite(d.area) && std::isfinite(d.volume));
  EXPECT_FALSE(d.is_body());
  EXPECT_EQ(findings(d).front().words, "3 vertices with coordinates that are not numbers");
  const Repaired good = without_broken(mesh);
  EXPECT_TRUE(examine(good.mesh).not_finite.empty());
  EXPECT_EQ(good.mesh.positions.size(), mesh.positions.size() - 3);
  EXPECT_EQ(good.changes.front().words, "3 vertices with coordinates that are not numbers removed");
}

TEST(Examine, ASoupIsWeldedIntoABody) {
  const TriMesh ball = sphere_mesh(0.03, 2), soup = soup_of(ball);
  const Diagnosis d = examine(soup);
  EXPECT_EQ(d.duplicate_vertices.size(), soup.positions.size() - ball.positions.size());
  EXPECT_EQ(d.holes.size(), ball.triangles.size());
  const Repaired one = welded(soup, 1e-6);
  EXPECT_EQ(one.mesh.positions.size(), ball.positions.size());
  EXPECT_EQ(one.mesh.triangles.size(), ball.triangles.size());
  EXPECT_TRUE(examine(one.mesh).is_body());
  EXPECT_FALSE(welded(one.mesh, 1e-6).changed());
}

TEST(Examine, CracksAreWeldedAtTheirBordersOnly) {
  TriMesh ball = sphere_mesh(1, 3);
  TriMesh upper = without(ball, [](Vec3d p) { return p.z < 0; }),
          lower = without(ball, [](Vec3d p) { return p.z > 0; });
  const TriMesh cracked = without_unused(together(upper, moved(lower, {0, 0, -0.004}))).mesh;
  EXPECT_EQ(examine(cracked).holes.size(), 2u);
  EXPECT_TRUE(examine(cracked).duplicate_vertices.empty()) << "too far for that";
  const Repaired closed = with_borders_welded(cracked, 0.01);
  EXPECT_TRUE(examine(closed.mesh).is_body());
  EXPECT_EQ(closed.mesh.positions.size(), ball.positions.size());
  EXPECT_FALSE(with_borders_welded(cracked, 0.003).changed());
}

TEST(Examine, TrianglesWithoutAreaAndThinOnesAreTold) {
  TriMesh mesh = box_mesh({1, 1, 1});
  mesh.positions.push_back({0.5, 0, 0});
  mesh.positions.push_back({0.5, 0.001, 0});
  mesh.triangles.push_back({0, 8, 1});
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({0, 9, 1});
  const Diagnosis d = examine(mesh);
  EXPECT_EQ(d.degenerate, (Places{12, 13}));
  EXPECT_EQ(d.slivers, (Places{14}));
  EXPECT_NEAR(d.least_angle, std::atan(0.002) * 180 / 3.14159265358979, 1e-9);
}

TEST(Examine, TrianglesThatAreThereTwiceAreToldAndLeftOut) {
  TriMesh mesh = box_mesh({1, 1, 1});
  mesh.triangles.push_back({mesh.triangles[4][1], mesh.triangles[4][2], mesh.triangles[4][0]});
  const Diagnosis d = examine(mesh);
  EXPECT_EQ(d.duplicate_triangles, (Edges{{12, 4}}));
  EXPECT_EQ(d.crowded_edges.size(), 3u);
  EXPECT_TRUE(d.crossings.empty());
  EXPECT_TRUE(examine(without_duplicates(mesh).mesh).is_body());
}

TEST(Examine, AWallBetweenTwoBodiesEnclosesNothing) {
  // Two boxes that share a face, which is there for both of them.
  TriMesh mesh = together(box_mesh({1, 1, 1}), moved(box_mesh({1, 1, 1}), {1, 0, 0}));
  for (auto& t : mesh.triangles)
    for (int& v : t) v = v == 8 ? 1 : v == 10 ? 3 : v == 12 ? 5 : v == 14 ? 7 : v;
  const Diagnosis before = examine(mesh);
  EXPECT_GT(before.crowded_edges.size(), 0u);
  const TriMesh one = without_unused(without_duplicates(mesh).mesh).mesh;
  EXPECT_EQ(one.triangles.size(), 20u) << before.duplicate_triangles.size();
  EXPECT_TRUE(examine(one).is_body());
  EXPECT_DOUBLE_EQ(volume(one), 2);
  const TriMesh sheet{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}};
  EXPECT_EQ(without_duplicates(sheet).mesh.triangles.size(), 1u) << "of a sheet with two faces one stays";
}

TEST(Examine, VerticesWithoutTrianglesAreTold) {
  TriMesh mesh = box_mesh({1, 1, 1});
  mesh.positions.insert(mesh.positions.begin(), {5, 5, 5});
  for (auto& t : mesh.triangles)
    for (int& v : t) ++v;
  const Diagnosis d = examine(mesh);
  EXPECT_EQ(d.unused, (Places{0}));
  EXPECT_EQ(d.box.high, (Vec3d{1, 1, 1}));
  EXPECT_TRUE(d.is_body()) << "it does no harm";
  EXPECT_EQ(without_unused(mesh).mesh.positions.size(), 8u);
}

TEST(Examine, EdgesAndCornersInWhichBodiesTouchAreFoundThere) {
  const Diagnosis edge = examine(boxes_at_an_edge());
  EXPECT_EQ(edge.crowded_edges, (Edges{{3, 7}}));
  EXPECT_EQ(edge.pinched_vertices, (Places{3, 7}));
  EXPECT_TRUE(edge.crossings.empty());
  const Diagnosis corner = examine(boxes_at_a_corner());
  EXPECT_TRUE(corner.crowded_edges.empty());
  EXPECT_EQ(corner.pinched_vertices, (Places{7}));
  EXPECT_FALSE(corner.is_body());
}

TEST(Examine, OneTurnedTriangleHasThreeTurnedEdges) {
  TriMesh mesh = box_mesh({1, 1, 1});
  std::swap(mesh.triangles[5][0], mesh.triangles[5][1]);
  EXPECT_EQ(examine(mesh).turned_edges.size(), 3u);
  EXPECT_EQ(remedies(mesh), (Names{"oriented"}));
}

TEST(Examine, WhatFacesInwardsIsToldUnlessItIsTheWallOfACavity) {
  EXPECT_EQ(examine(turned_inside_out(box_mesh({1, 1, 1}))).inward, (Places{0}));
  const TriMesh hollow =
      together(box_mesh({1, 1, 1}), moved(turned_inside_out(box_mesh({0.5, 0.5, 0.5})), {0.2, 0.2, 0.2}));
  const Diagnosis d = examine(hollow);
  EXPECT_TRUE(d.inward.empty());
  EXPECT_TRUE(d.shells.list[1].is_cavity);
  EXPECT_DOUBLE_EQ(d.volume, 1 - 0.125);
  EXPECT_TRUE(d.is_body());
  const TriMesh beside =
      together(box_mesh({1, 1, 1}), moved(turned_inside_out(box_mesh({0.5, 0.5, 0.5})), {2, 0.2, 0.2}));
  EXPECT_EQ(examine(beside).inward, (Places{1}));
}

TEST(Examine, HolesAreLoopsWithTheirLength) {
  const TriMesh tube = open_tube(0.01, 0.05, 24, 10);
  const Diagnosis d = examine(tube);
  ASSERT_EQ(d.holes.size(), 2u);
  for (const Rim& rim : d.holes) {
    EXPECT_TRUE(rim.is_loop);
    EXPECT_EQ(rim.vertices.size(), 24u);
    EXPECT_NEAR(rim.length, 24 * 2 * 0.01 * std::sin(3.14159265358979 / 24), 1e-9);
  }
  EXPECT_EQ(d.open_edges(), 48);
  const double base = 12 * std::sin(2 * 3.14159265358979 / 24) * 1e-4;  // of the polygon of 24 corners
  EXPECT_NEAR(d.volume, base * 0.05, 1e-12) << "as if closed by flat fans";
  EXPECT_NEAR(d.shells.list[0].caps, 2 * base, 1e-12);
  EXPECT_EQ(findings(d).front().words, "2 holes, 48 open edges, the longest 62.7 mm around");
}

TEST(Examine, HolesThatMeetInACornerAreTwo) {
  TriMesh mesh = sphere_mesh(1, 2);
  const int v = 0;
  int gone = 0;  // two triangles at one vertex that are not neighbours
  std::vector<std::array<int, 3>> kept;
  std::array<int, 3> first{-1, -1, -1};
  for (const auto& t : mesh.triangles) {
    const bool at = t[0] == v || t[1] == v || t[2] == v;
    int common = 0;
    for (const int a : t)
      for (const int b : first) common += a == b;
    if (at && (gone == 0 || (gone == 1 && common == 1))) {
      first = t;
      ++gone;
    } else {
      kept.push_back(t);
    }
  }
  ASSERT_EQ(gone, 2);
  mesh.triangles = kept;
  const Diagnosis d = examine(mesh);
  ASSERT_EQ(d.holes.size(), 1u) << "around each of the two fans it goes from one hole over into the other";
  EXPECT_EQ(d.holes[0].vertices.size(), 6u);
  EXPECT_EQ(d.pinched_vertices, (Places{v}));
}

TEST(Examine, ShellsAreListedWithAreaAndVolume) {
  const TriMesh mesh = together(box_mesh({1, 1, 1}), moved(box_mesh({0.1, 0.1, 0.1}), {3, 0, 0}));
  const Diagnosis d = examine(mesh);
  ASSERT_EQ(d.shells.list.size(), 2u);
  EXPECT_DOUBLE_EQ(d.shells.list[0].area, 6);
  EXPECT_NEAR(d.shells.list[1].volume, 0.001, 1e-15);
  EXPECT_EQ(d.shells.of[12], 1);
  EXPECT_TRUE(d.is_body());
  EXPECT_EQ(remedies(mesh), (Names{"without_small_shells"}));
  const Repaired one = without_small_shells(mesh, 0.05);
  EXPECT_EQ(one.mesh.triangles.size(), 12u);
  EXPECT_EQ(one.mesh.positions.size(), 8u);
  EXPECT_EQ(without_small_shells(mesh, 0.05, true).mesh.triangles.size(), 24u) << "closed ones stay";
}

TEST(Examine, CrossingsAreToldAsPairsOfTriangles) {
  const TriMesh mesh = together(box_mesh({1, 1, 1}), moved(box_mesh({1, 1, 1}), {0.4, 0.3, 0.2}));
  const Diagnosis d = examine(mesh);
  EXPECT_FALSE(d.is_body());
  EXPECT_GT(d.crossings.size(), 5u);
  for (const auto& [a, b] : d.crossings) EXPECT_TRUE(a < 12 && b >= 12);
  ExamineOptions quick;
  quick.crossings = false;
  EXPECT_TRUE(examine(mesh, quick).crossings.empty());
}

}  // namespace trocar::geometry
