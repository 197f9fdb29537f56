// What each repair does to a mesh that has the fault it is for, and that it does no more.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/geometry/remesh/editable.hpp>
#include <trocar/geometry/repair/degenerate.hpp>
#include <trocar/geometry/repair/examine.hpp>
#include <trocar/geometry/repair/holes.hpp>
#include <trocar/geometry/repair/oriented.hpp>
#include <trocar/geometry/repair/parted.hpp>
#include <trocar/geometry/repair/refilled.hpp>
#include <trocar/geometry/repair/rim_bridge.hpp>
#include <trocar/geometry/repair/rim_patch.hpp>
#include <trocar/geometry/repair/untangled.hpp>

#include "broken_meshes.hpp"

namespace trocar::geometry {
namespace {

bool all_one_body(const TriMesh& mesh) { return examine(mesh).is_body(); }
constexpr double kPi = 3.14159265358979;

}  // namespace

TEST(Parted, BodiesThatTouchInAnEdgeOrACornerBecomeTwo) {
  for (const TriMesh& touching : {boxes_at_an_edge(), boxes_at_a_corner()}) {
    const Repaired apart = parted(touching);
    const Diagnosis d = examine(apart.mesh);
    EXPECT_TRUE(d.is_body()) << in_words(d);
    EXPECT_EQ(d.shells.list.size(), 2u);
    EXPECT_DOUBLE_EQ(d.volume, 2);
    EXPECT_EQ(apart.mesh.triangles.size(), 24u);
    EXPECT_FALSE(parted(apart.mesh).changed());
  }
  EXPECT_EQ(parted(boxes_at_an_edge()).changes.front().words, "1 edge with more than two triangles parted");
}

TEST(Parted, TheSameWhicheverWayTrianglesFace) {
  TriMesh mesh = boxes_at_an_edge();
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  const Diagnosis d = examine(parted(mesh).mesh);
  EXPECT_TRUE(d.crowded_edges.empty() && d.pinched_vertices.empty() && d.crossings.empty());
  EXPECT_EQ(d.open_edges(), 0);
}

TEST(Parted, AnEdgeWhoseEndsHangTogetherAnywayGetsAVertexInItsMiddle) {
  // A body bent round until an edge of one end lies on an edge of the other: both its vertices have one fan.
  TriMesh mesh = sphere_mesh(1, 2);
  const auto first = edges(mesh).front();
  int other = -1;
  for (std::size_t e = 0; e < edges(mesh).size() && other < 0; ++e) {
    const auto [a, b] = edges(mesh)[e];
    if (a != first[0] && a != first[1] && b != first[0] && b != first[1] &&
        length(mesh.positions[a] + mesh.positions[first[0]]) < 1.0)
      other = int(e);
  }
  ASSERT_GE(other, 0);
  const auto [a, b] = edges(mesh)[std::size_t(other)];
  for (auto& t : mesh.triangles)
    for (int& v : t) v = v == a ? first[0] : (v == b ? first[1] : v);
  ASSERT_EQ(examine(mesh, {1e-6, 1, false}).crowded_edges.size(), 1u);
  const Diagnosis d = examine(parted(mesh).mesh, {1e-6, 1, false});
  EXPECT_TRUE(d.crowded_edges.empty() && d.pinched_vertices.empty());
  EXPECT_EQ(d.open_edges(), 0);
}

TEST(Parted, OfThreeSheetsAtAnEdgeTheFlattestTwoStayTogether) {
  TriMesh mesh{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5}, {-1, 0.1, 0.5}, {0.2, 1, 0.5}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
  const TriMesh apart = parted(mesh).mesh;
  const EdgeTable edges(apart);
  EXPECT_EQ(edges.across(0, 0), 1);
  EXPECT_EQ(edges.across(2, 0), EdgeTable::kOpen);
  EXPECT_EQ(apart.positions.size(), 7u);
}

TEST(Oriented, EveryTriangleFacesOutwardsWhicheverWayItDid) {
  core::Random random(7);
  const TriMesh ball = together(sphere_mesh(1, 3), moved(box_mesh({1, 1, 1}), {3, 0, 0}));
  TriMesh shuffled = ball;
  for (auto& t : shuffled.triangles)
    if (random.uniform() < 0.5) std::swap(t[1], t[2]);
  const Repaired good = oriented(shuffled);
  EXPECT_TRUE(all_one_body(good.mesh));
  EXPECT_DOUBLE_EQ(volume(good.mesh), volume(ball));
  EXPECT_FALSE(oriented(ball).changed());
  EXPECT_DOUBLE_EQ(volume(oriented(turned_inside_out(ball)).mesh), volume(ball));
}

TEST(Oriented, WallsOfCavitiesStayAndBodiesWithinBodiesDoToo) {
  const TriMesh hollow = together(sphere_mesh(1, 2), turned_inside_out(sphere_mesh(0.5, 2)));
  EXPECT_FALSE(oriented(hollow).changed());
  const TriMesh stone = together(sphere_mesh(1, 2), sphere_mesh(0.5, 2));
  EXPECT_FALSE(oriented(stone).changed());
}

TEST(Oriented, AStripWithOneSideOnlyIsPartedSomewhere) {
  const Repaired two_sided = oriented(moebius_strip(24));
  const Diagnosis d = examine(two_sided.mesh);
  EXPECT_TRUE(d.turned_edges.empty());
  EXPECT_EQ(d.triangles, 48);
  EXPECT_EQ(two_sided.changes.front().words, "1 edge parted, as the surface has one side only");
}

TEST(Degenerate, FlatTrianglesGoAndNoHoleIsLeft) {
  // A corner on the long side of its neighbour, and two corners at nearly the same place.
  TriMesh flat = box_mesh({1, 1, 1});
  EditableMesh work(flat);
  const int middle = work.split(0, 1, {0.5, 0, 0});
  const int near = work.split(middle, 1, {0.5 + 1e-13, 0, 0});
  ASSERT_GE(near, 0);
  flat = work.taken();
  flat.positions[std::size_t(middle)] = {0.5, 0, 0};
  EXPECT_EQ(examine(flat).degenerate.size(), 2u);
  const Repaired good = without_degenerate(flat);
  EXPECT_TRUE(all_one_body(good.mesh)) << in_words(examine(good.mesh));
  EXPECT_NEAR(volume(good.mesh), 1, 1e-12);
  EXPECT_FALSE(without_degenerate(good.mesh).changed());
}

TEST(Degenerate, AFlatTriangleIsFlippedIntoItsNeighbour) {
  TriMesh mesh{{{0, 0, 0}, {2, 0, 0}, {1, 1e-12, 0}, {1, -1, 0}, {1, 1, 0}},
               {{0, 1, 2}, {1, 0, 3}, {0, 2, 4}, {2, 1, 4}}};
  const TriMesh good = without_degenerate(mesh).mesh;
  EXPECT_TRUE(examine(good).degenerate.empty());
  EXPECT_NEAR(area(good), 2, 1e-9);
  EXPECT_EQ(examine(good).open_edges(), 4);
}

TEST(RimPatch, OfALoopInAPlaneThePatchIsThePolygon) {
  PatchLoop loop;
  for (const Vec3d p : {Vec3d{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}})
    loop.places.push_back(p);
  loop.normals.assign(6, Vec3d{});
  const auto triangles = rim_patch(loop);
  ASSERT_EQ(triangles.size(), 4u);
  for (const auto& [a, b, c] : triangles)
    EXPECT_GT(cross(loop.places[b] - loop.places[a], loop.places[c] - loop.places[a]).z, 0);
  loop.taken = [](int i, int j) { return i + j == 3 && std::min(i, j) == 0; };
  for (const auto& [a, b, c] : rim_patch(loop)) {
    const auto is_taken = [](int i, int j) { return std::min(i, j) == 0 && std::max(i, j) == 3; };
    EXPECT_FALSE(is_taken(a, b) || is_taken(b, c) || is_taken(c, a));
  }
  loop.taken = [](int, int) { return true; };
  EXPECT_TRUE(rim_patch(loop).empty()) << "every way would use an edge that is there";
}

TEST(RimPatch, LongLoopsAreShortenedFirstAndStillCovered) {
  PatchLoop loop;
  const int n = 3 * kMostPatchCorners;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * kPi * i / n;
    loop.places.push_back({std::cos(angle), std::sin(angle), 0.1 * std::cos(2 * angle)});
  }
  loop.normals.assign(std::size_t(n), Vec3d{});
  const auto triangles = rim_patch(loop);
  EXPECT_EQ(int(triangles.size()), n - 2);
  double sum = 0;
  for (const auto& [a, b, c] : triangles)
    sum += 0.5 * cross(loop.places[b] - loop.places[a], loop.places[c] - loop.places[a]).z;
  EXPECT_NEAR(sum, kPi, 1e-3) << "seen from above it is the disc";
}

TEST(Holes, ASmallHoleInABallIsClosedAsTheBallGoesOn) {
  const TriMesh ball = sphere_mesh(0.03, 4);
  const TriMesh open = without(ball, [](Vec3d p) { return p.z > 0.0275; });
  EXPECT_EQ(examine(open).holes.size(), 1u);
  const Repaired closed = with_holes_closed(open);
  EXPECT_TRUE(all_one_body(closed.mesh));
  EXPECT_NEAR(volume(closed.mesh), volume(ball), 0.001 * volume(ball));
  double highest = 0;
  for (const Vec3d& p : closed.mesh.positions) {
    highest = std::max(highest, p.z);
    EXPECT_NEAR(length(p), 0.03, 0.0007);
  }
  EXPECT_GT(highest, 0.029) << "a flat lid would be at 0.0275";
  HoleOptions flat;
  flat.smooth = false;
  const TriMesh lid = with_holes_closed(open, flat).mesh;
  EXPECT_TRUE(all_one_body(lid));
  EXPECT_LT(volume(lid), volume(closed.mesh));
}

TEST(Holes, EndsOfATubeAreClosedFlatAndAsFineAsTheTube) {
  const Repaired closed = with_holes_closed(open_tube(0.01, 0.05, 24, 12));
  const Diagnosis d = examine(closed.mesh);
  EXPECT_TRUE(d.is_body());
  EXPECT_NEAR(d.volume, 12 * std::sin(2 * kPi / 24) * 1e-4 * 0.05, 1e-10);
  EXPECT_GT(d.least_angle, 15);
  for (const Vec3d& p : closed.mesh.positions) EXPECT_TRUE(p.z > -1e-9 && p.z < 0.05 + 1e-9);
  EXPECT_EQ(closed.changes.front().words, "2 holes closed, the largest of 3.11 cm2");
}

TEST(Holes, BetweenTheRimsOfAWallThereIsARingAndTheLumenStaysOpen) {
  const TriMesh wall = open_wall(0.012, 0.01, 0.05, 32, 12);
  EXPECT_EQ(examine(wall).holes.size(), 4u);
  const Repaired closed = with_holes_closed(wall);
  const Diagnosis d = examine(closed.mesh);
  EXPECT_TRUE(d.is_body()) << in_words(d);
  EXPECT_EQ(d.shells.list.size(), 1u);
  const double outer = 16 * std::sin(2 * kPi / 32) * 1.44e-4, inner = 17.5 * std::sin(2 * kPi / 35) * 1e-4;
  EXPECT_NEAR(d.volume, (outer - inner) * 0.05, 1e-11);
  EXPECT_EQ(closed.changes.front().words, "2 walls closed by rings between their rims");
  HoleOptions lids;
  lids.rings = false;
  EXPECT_EQ(examine(with_holes_closed(wall, lids).mesh).shells.list.size(), 2u);
}

TEST(Holes, RimsArePairedOnlyWhereOneLiesWithinTheOther) {
  const TriMesh apart =
      together(open_tube(0.01, 0.05, 24, 6), turned_inside_out(moved(open_tube(0.008, 0.05, 24, 6), {0.03, 0, 0})));
  const EdgeTable edges(apart);
  EXPECT_TRUE(concentric_rims(apart, rims_of(apart, edges)).empty());
  const TriMesh solid = together(open_tube(0.01, 0.05, 24, 6), open_tube(0.008, 0.05, 24, 6));
  const EdgeTable other(solid);
  EXPECT_TRUE(concentric_rims(solid, rims_of(solid, other)).empty()) << "both face outwards: no wall";
}

TEST(Holes, ASheetIsLeftOpenAndTold) {
  const TriMesh sheet = without(sphere_mesh(0.03, 4), [](Vec3d p) { return p.z < 0.025; });
  const Repaired left = with_holes_closed(sheet);
  EXPECT_FALSE(left.changed());
  ASSERT_EQ(left.left.size(), 1u);
  EXPECT_EQ(left.left[0].substr(0, 10), "a sheet of");
  HoleOptions all;
  all.sheets = true;
  EXPECT_TRUE(all_one_body(with_holes_closed(sheet, all).mesh));
}

TEST(Refilled, TwoBallsThatOverlapBecomeOneBodyOfTheirVolume) {
  const double apart = 0.04, radius = 0.03;
  const TriMesh two = together(sphere_mesh(radius, 4), moved(sphere_mesh(radius, 4), {apart, 0, 0}));
  const Refilled one = refilled(two, {0.003, 400'000});
  const Diagnosis d = examine(one.mesh);
  EXPECT_TRUE(d.is_body());
  EXPECT_EQ(d.shells.list.size(), 1u);
  const double cap = radius - apart / 2, lens = 2 * kPi * cap * cap * (3 * radius - cap) / 3;
  const double exact = 2 * 4 * kPi / 3 * radius * radius * radius - lens;
  EXPECT_NEAR(d.volume, exact, 0.02 * exact);
  EXPECT_LT(one.farthest, 0.03) << "what lies within the other ball is far from the new surface";
  EXPECT_TRUE(refilled(without(two, [](Vec3d p) { return p.x > 0.06; })).mesh.triangles.empty());
  EXPECT_FALSE(refilled(without(two, [](Vec3d p) { return p.x > 0.06; })).why.empty());
}

TEST(Refilled, ASheetGetsAThickness) {
  TriMesh square{{{0, 0, 0}, {0.04, 0, 0}, {0.04, 0.04, 0}, {0, 0.04, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const Refilled wall = thickened(square, 0.004);
  EXPECT_TRUE(all_one_body(wall.mesh));
  const double inside = 0.04 * 0.04 * 0.004, rim = 4 * 0.04 * kPi * 0.002 * 0.002 / 2, corners = 4 * kPi / 3 * 8e-9;
  EXPECT_NEAR(volume(wall.mesh), inside + rim + corners, 0.05 * inside);
  EXPECT_FALSE(thickened(square, 0).why.empty());
}

TEST(Untangled, ACornerThatWentThroughTheOtherSideIsDrawnBack) {
  const TriMesh ball = sphere_mesh(0.03, 4);
  TriMesh broken = ball;
  broken.positions[700] *= -1.1;
  ASSERT_FALSE(examine(broken).crossings.empty());
  const Repaired good = untangled(broken);
  EXPECT_TRUE(good.left.empty());
  EXPECT_TRUE(all_one_body(good.mesh)) << in_words(examine(good.mesh));
  EXPECT_NEAR(volume(good.mesh), volume(ball), 0.01 * volume(ball));
  int moved_places = 0;
  for (std::size_t v = 0; v < ball.positions.size(); ++v)
    moved_places += std::find(good.mesh.positions.begin(), good.mesh.positions.end(), ball.positions[v]) ==
                    good.mesh.positions.end();
  EXPECT_LT(moved_places, 30);
}

TEST(Untangled, WhatCannotBeEasedIsCutOutAndPatched) {
  // A bump that leans over until its top is within the ball again.
  TriMesh ball = sphere_mesh(0.03, 5);
  for (Vec3d& p : ball.positions) {
    const double height = p.z > 0.027 ? (p.z - 0.027) / 0.003 : 0;
    p += height * Vec3d{0.03, 0, 0.012} - height * height * Vec3d{0, 0, 0.03};
  }
  ASSERT_FALSE(examine(ball).crossings.empty());
  const Repaired good = untangled(ball);
  EXPECT_TRUE(good.left.empty());
  EXPECT_TRUE(all_one_body(good.mesh)) << in_words(examine(good.mesh));
  EXPECT_NE(good.changes.back().words.find("at crossings removed"), std::string::npos);
}

}  // namespace trocar::geometry
