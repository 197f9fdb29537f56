// Surfaces cut along their crossings, and what the cutting is made of.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/geometry/repair/cut_triangle.hpp>
#include <trocar/geometry/repair/examine.hpp>
#include <trocar/geometry/repair/resolved.hpp>
#include <trocar/geometry/volumes/field.hpp>

#include "broken_meshes.hpp"

namespace trocar::geometry {
namespace {

constexpr double kTurn = 3.14159265358979;

/// A rod of n sides whose path winds through itself: pushed along a figure eight.
TriMesh figure_eight(int around, int along) {
  TriMesh mesh;
  for (int j = 0; j < along; ++j) {
    const double t = 2 * kTurn * j / along;
    const Vec3d at{std::sin(t), std::sin(t) * std::cos(t), 0.1 * std::sin(t + 0.3)};
    const Vec3d way = normalised(Vec3d{std::cos(t), std::cos(2 * t), 0.1 * std::cos(t + 0.3)});
    const Vec3d side = normalised(cross(way, Vec3d{0, 0, 1})), up = cross(side, way);
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * kTurn * (i + 0.3) / around;
      mesh.positions.push_back(at + 0.2 * (std::cos(angle) * side + std::sin(angle) * up));
    }
  }
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < around; ++i) {
      const int a = j * around + i, b = j * around + (i + 1) % around;
      const int c = (j + 1) % along * around + (i + 1) % around, d = (j + 1) % along * around + i;
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

}  // namespace

TEST(CutTriangle, PointsAndSegmentsBecomeCornersAndEdges) {
  const std::vector<Vec3d> places{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}, {2, 0, 1}, {1, 1, 1}, {0, 2, 1}, {1.5, 1.5, 1}};
  CutTriangle cut(places, {0, 1, 2});
  cut.add_on_side(0, {3});
  cut.add_on_side(2, {5});
  cut.add_within(4);
  cut.add_within(6);
  cut.constrain(3, 4);
  cut.constrain(4, 5);
  cut.widen();
  ASSERT_TRUE(cut.good());
  double sum = 0;
  int edges = 0;
  for (const auto& t : cut.triangles()) {
    const double twice = cross(places[t[1]] - places[t[0]], places[t[2]] - places[t[0]]).z;
    EXPECT_GT(twice, 0);
    sum += 0.5 * twice;
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      edges += (a == 3 && b == 4) + (a == 4 && b == 3) + (a == 4 && b == 5) + (a == 5 && b == 4);
    }
  }
  EXPECT_DOUBLE_EQ(sum, 8);
  EXPECT_EQ(edges, 4) << "each segment from both sides";
}

TEST(CutTriangle, WhatCannotBeDoneIsNoTriangulation) {
  const std::vector<Vec3d> places{{0, 0, 0},     {4, 0, 0}, {0, 4, 0}, {3, 3, 0},
                                  {0.5, 0.5, 0}, {1, 2, 0}, {2, 1, 0}, {1.7, 1.7, 0}};
  CutTriangle outside(places, {0, 1, 2});
  outside.add_within(3);
  EXPECT_FALSE(outside.good());
  CutTriangle crossing(places, {0, 1, 2});
  for (const int p : {4, 5, 6, 7}) crossing.add_within(p);
  crossing.constrain(5, 6);
  crossing.constrain(4, 0);
  EXPECT_TRUE(crossing.good());
  crossing.constrain(4, 7);
  EXPECT_FALSE(crossing.good()) << "segments that cross";
}

TEST(CutTriangle, RandomSegmentsThatDoNotCrossAreAllEdges) {
  core::Random random(4);
  for (int round = 0; round < 50; ++round) {
    const std::vector<Vec3d> places{{0, 0, 0}, {1, 0, 0.3}, {0, 1, -0.2}};
    const int lines = 12;
    std::vector<Vec3d> all = places;
    for (int i = 0; i < 2 * lines; ++i) {  // pairs on parallel lines: they do not cross
      const double x = (i / 2 + 0.5) / (lines + 1), y = (random.uniform() * 0.9 + 0.05) * (1 - x);
      all.push_back(x * (places[1] - places[0]) + y * (places[2] - places[0]));
    }
    CutTriangle many(all, {0, 1, 2});
    for (int p = 3; p < int(all.size()); ++p) many.add_within(p);
    for (int i = 0; i < lines; ++i) many.constrain(3 + 2 * i, 4 + 2 * i);
    ASSERT_TRUE(many.good());
    EXPECT_EQ(int(many.triangles().size()), 1 + 2 * 2 * lines);
    double sum = 0;
    for (const auto& t : many.triangles()) sum += 0.5 * length(cross(all[t[1]] - all[t[0]], all[t[2]] - all[t[0]]));
    EXPECT_NEAR(sum, 0.5 * length(cross(places[1], places[2])), 1e-12);
  }
}

TEST(Resolved, TwoBoxesThatOverlapBecomeTheirUnionExactly) {
  const TriMesh two = together(box_mesh({1, 1, 1}), moved(box_mesh({1, 1, 1}), {0.4, 0.3, 0.2}));
  const Repaired one = resolved(two);
  const Diagnosis d = examine(one.mesh);
  EXPECT_TRUE(d.is_body()) << in_words(d);
  EXPECT_EQ(d.shells.list.size(), 1u);
  EXPECT_NEAR(d.volume, 2 - 0.6 * 0.7 * 0.8, 1e-12);
  EXPECT_NEAR(d.area, 12 - 2 * (0.6 * 0.7 + 0.7 * 0.8 + 0.6 * 0.8), 1e-12);
}

TEST(Resolved, BoxesWhoseFacesLieInEachOtherAreNudgedApart) {
  const TriMesh flush = together(box_mesh({1, 1, 1}), moved(box_mesh({1, 1, 1}), {0.5, 0, 0}));
  const Repaired one = resolved(flush);
  const Diagnosis d = examine(one.mesh);
  EXPECT_TRUE(one.left.empty());
  EXPECT_TRUE(d.shells.list.size() >= 1 && d.crossings.empty() && d.holes.empty());
  EXPECT_NEAR(d.volume, 1.5, 1e-5);
  const TriMesh standing = together(box_mesh({1, 1, 1}), moved(box_mesh({0.5, 0.5, 0.5}), {0.25, 0.25, 1}));
  EXPECT_FALSE(examine(standing).crossings.empty()) << "touching counts";
  EXPECT_NEAR(volume(resolved(standing).mesh), 1.125, 1e-5);
  EXPECT_TRUE(examine(resolved(standing).mesh).crossings.empty());
}

TEST(Resolved, ThreeBallsThatAllOverlapBecomeOne) {
  const double r = 1;
  const TriMesh three = together(together(sphere_mesh(r, 3), moved(sphere_mesh(r, 3), {0.9, 0.1, 0.05})),
                                 moved(sphere_mesh(r, 3), {0.45, 0.8, -0.1}));
  const Repaired one = resolved(three);
  const Diagnosis d = examine(one.mesh);
  EXPECT_TRUE(d.is_body());
  EXPECT_EQ(d.shells.list.size(), 1u);
  // By the share of random places within any of the three.
  core::Random random(1);
  int within = 0;
  const int count = 200'000;
  const Vec3d middles[] = {{0, 0, 0}, {0.9, 0.1, 0.05}, {0.45, 0.8, -0.1}};
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-1, 1.9), y = random.uniform(-1, 1.8), z = random.uniform(-1.1, 1.05);
    bool in = false;
    for (const Vec3d& m : middles) in = in || length(Vec3d{x, y, z} - m) < r;
    within += in;
  }
  const double share = volume(sphere_mesh(r, 3)) / (4 * kTurn / 3);
  EXPECT_NEAR(d.volume, double(within) / count * 2.9 * 2.8 * 2.15 * share, 0.03 * d.volume);
}

TEST(Resolved, ABodyThatGoesThroughItselfKeepsItsHoles) {
  const TriMesh eight = figure_eight(12, 60);
  ASSERT_TRUE(check_edges(eight).closed());
  ASSERT_GT(volume(eight), 0);
  ASSERT_FALSE(examine(eight).crossings.empty());
  const Repaired one = resolved(eight);
  const Diagnosis d = examine(one.mesh);
  EXPECT_TRUE(d.is_body()) << in_words(d);
  EXPECT_EQ(d.shells.list.size(), 1u);
  EXPECT_LT(d.volume, volume(eight)) << "what it passed through twice counts once";
  const int euler = d.vertices - int(edges(one.mesh).size()) + d.triangles;
  EXPECT_EQ(euler, -2) << "two eyes";
}

TEST(Resolved, AWallThatIsTooThinGetsAHole) {
  // A cavity that reaches through the outside: taken away, not added.
  const TriMesh wall = together(sphere_mesh(1, 3), moved(turned_inside_out(sphere_mesh(0.5, 3)), {0.7, 0.01, 0.02}));
  const Repaired open = resolved(wall);
  const Diagnosis d = examine(open.mesh);
  EXPECT_TRUE(d.is_body());
  EXPECT_EQ(d.shells.list.size(), 1u);
  const double dx = 0.7, big = 1, small = 0.5;
  const double lens = kTurn * (big + small - dx) * (big + small - dx) *
                      (dx * dx + 2 * dx * small - 3 * small * small + 2 * dx * big + 6 * small * big - 3 * big * big) /
                      (12 * dx);
  const double share = volume(sphere_mesh(1, 3)) / (4 * kTurn / 3);  // of a ball that the mesh fills
  EXPECT_NEAR(d.volume, (4 * kTurn / 3 - lens) * share, 0.02);
}

TEST(Resolved, WhatCrossesNothingStaysToTheBit) {
  const TriMesh mesh = together(sphere_mesh(0.3, 3), moved(sphere_mesh(0.3, 3), {0.61, 0, 0}));
  const Repaired same = resolved(mesh);
  EXPECT_FALSE(same.changed());
  EXPECT_EQ(same.mesh.positions, mesh.positions);
  const TriMesh third = together(mesh, moved(sphere_mesh(0.3, 3), {0.61, 0.4, 0}));
  const TriMesh one = resolved(third).mesh;
  for (int v = 0; v < 100; ++v)  // the first ball has no part in it
    EXPECT_NE(std::find(one.positions.begin(), one.positions.end(), mesh.positions[std::size_t(v)]),
              one.positions.end());
}

TEST(Resolved, RandomHeapsOfBodiesAlwaysBecomeBodies) {
  core::Random random(12);
  for (int round = 0; round < 12; ++round) {
    TriMesh heap;
    for (int body = 0; body < 5; ++body) {
      const double x = random.uniform(), y = random.uniform(), z = random.uniform();
      append(heap, moved(body % 2 == 0 ? box_mesh({0.9, 0.7, 0.8}) : sphere_mesh(0.5, 2), {x, y, z}));
    }
    const Repaired one = resolved(heap);
    EXPECT_TRUE(one.left.empty()) << round;
    const Diagnosis d = examine(one.mesh);
    EXPECT_TRUE(d.crossings.empty() && d.holes.empty() && d.turned_edges.empty()) << in_words(d);
    const Field before = field_of(heap), after = field_of(one.mesh);  // another way to tell inside: along a ray
    const Vec3d side = before.box.high - before.box.low;
    int inside = 0, differ = 0;
    const int count = 4000;
    for (int i = 0; i < count; ++i) {
      const double x = random.uniform(), y = random.uniform(), z = random.uniform();
      const Vec3d p = before.box.low + Vec3d{x * side.x, y * side.y, z * side.z};
      const bool in = before.inside(p) > 0;
      inside += in;
      differ += in != (after.inside(p) > 0);
    }
    EXPECT_EQ(differ, 0) << "the same places are inside";
    EXPECT_NEAR(d.volume, double(inside) / count * side.x * side.y * side.z, 0.08 * d.volume);
  }
}

TEST(Resolved, GivesTheSameMeshEveryTime) {
  const TriMesh two = together(box_mesh({1, 1, 1}), moved(box_mesh({1, 1, 1}), {0.5, 0, 0}));
  const TriMesh a = resolved(two).mesh, b = resolved(two).mesh;
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.triangles, b.triangles);
}

}  // namespace trocar::geometry
