// Signs without rounding, and what is asked by them: do triangles cross?
#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/geometry/surfaces/crossings.hpp>
#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/geometry/surfaces/orientation.hpp>

#include "shapes.hpp"

namespace trocar::geometry {
namespace {

Vec3d random_place(core::Random& random) {
  const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
  return {x, y, z};
}
/// On a coarse grid, where much is in one plane, moved far away.
Vec3d grid_place(core::Random& random) {
  const auto at = [&] { return double(int(random.uniform() * 4)) + 1e6; };
  const double x = at(), y = at(), z = at();
  return {x, y, z};
}
long long whole_side(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  const Vec3d u = b - a, v = c - a, w = d - a;  // small whole numbers
  return static_cast<long long>(dot(cross(u, v), w));
}
int sign_of(long long v) { return v > 0 ? 1 : (v < 0 ? -1 : 0); }

}  // namespace

TEST(Orientation, OfWholeNumbersTheSignIsThatOfWholeArithmetic) {
  core::Random random(3);
  int flat = 0;
  for (int round = 0; round < 20'000; ++round) {
    const Vec3d a = grid_place(random), b = grid_place(random), c = grid_place(random), d = grid_place(random);
    const int sign = sign_of(whole_side(a, b, c, d));
    flat += sign == 0;
    EXPECT_EQ(side_of_plane(a, b, c, d), sign);
    const Vec3d u = b - a, v = c - a;
    EXPECT_EQ(side_of_line(a, b, c, 0, 1), sign_of(static_cast<long long>(u.x * v.y - u.y * v.x)));
  }
  EXPECT_GT(flat, 1000);
}

TEST(Orientation, AStepOfTheLastBitOffAPlaneIsSeenFromEveryOrderOfCorners) {
  // The plane through three points of sevenths and elevenths: what a fourth that is computed on it makes of rounding.
  core::Random random(5);
  int decided = 0;
  for (int round = 0; round < 2000; ++round) {
    const Vec3d a = random_place(random), b = random_place(random), c = random_place(random);
    const double u = random.uniform(), v = random.uniform();
    const Vec3d d = a + u * (b - a) + v * (c - a);
    const int side = side_of_plane(a, b, c, d);
    EXPECT_EQ(side_of_plane(b, c, a, d), side);
    EXPECT_EQ(side_of_plane(b, a, c, d), -side);
    EXPECT_EQ(side_of_plane(a, b, d, c), -side);
    EXPECT_EQ(side_of_plane(d, c, b, a), side);
    decided += side != 0;
  }
  EXPECT_GT(decided, 1000);
  EXPECT_EQ(side_of_plane({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 5e-324}), 1);
  EXPECT_EQ(side_of_line({0, 0, 0}, {3, 1, 0}, {6, 2, 0}, 0, 1), 0);
  EXPECT_EQ(side_of_line({0.1, 0.1, 0}, {0.3, 0.3, 0}, {0.7, 0.7, 0}, 0, 1), 0);
  EXPECT_EQ(side_of_line({0.1, 0.1, 0}, {0.3, 0.3, 0}, {0.7, 0.70000000000000007, 0}, 0, 1), 1);
}

TEST(Crossings, TrianglesCrossWhereAnEdgeOfOneGoesThroughTheOther) {
  const TriangleCorners flat{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}};
  EXPECT_TRUE(triangles_cross(flat, {{{0.5, 0.5, -1}, {0.5, 0.5, 1}, {3, 3, 0.5}}}));
  EXPECT_FALSE(triangles_cross(flat, {{{0.5, 0.5, 0.1}, {0.5, 0.5, 1}, {3, 3, 0.5}}}));
  EXPECT_FALSE(triangles_cross(flat, {{{2, 2, -1}, {2, 2, 1}, {3, 3, 0}}}));
}

TEST(Crossings, WhatTouchesCrosses) {
  const TriangleCorners flat{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}};
  EXPECT_TRUE(triangles_cross(flat, {{{0.5, 0.5, 0}, {0.5, 0.5, 1}, {3, 3, 1}}}));      // a corner on the face
  EXPECT_TRUE(triangles_cross(flat, {{{1, 0, 0}, {1, -1, 1}, {2, -1, 1}}}));            // a corner on an edge
  EXPECT_TRUE(triangles_cross(flat, {{{1, -1, 0}, {1, 1, 0}, {1, 0, 3}}}));             // an edge on the face
  EXPECT_TRUE(triangles_cross(flat, {{{0.2, 0.2, 0}, {0.4, 0.2, 0}, {0.2, 0.4, 0}}}));  // one within the other
  EXPECT_TRUE(triangles_cross(flat, {{{-5, -5, 0}, {9, -5, 0}, {-5, 9, 0}}}));
  EXPECT_FALSE(triangles_cross(flat, {{{3, 3, 0}, {4, 3, 0}, {3, 4, 0}}}));
}

TEST(Crossings, NeighboursCrossOnlyBeyondWhatTheyShare) {
  const Vec3d a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0}, above{0.2, -0.5, 1};
  EXPECT_FALSE(triangles_cross({a, b, c}, {b, a, above}));
  EXPECT_FALSE(triangles_cross({a, b, c}, {b, a, Vec3d{0.5, -1, 0}})) << "flat, on the other side of the edge";
  EXPECT_TRUE(triangles_cross({a, b, c}, {b, a, Vec3d{0.5, 0.7, 0}})) << "folded onto it";
  EXPECT_FALSE(triangles_cross({a, b, c}, {c, b, a})) << "duplicates are another fault";
  EXPECT_FALSE(triangles_cross({a, b, c}, {a, above, Vec3d{-1, 0, 0}}));
  EXPECT_TRUE(triangles_cross({a, b, c}, {a, Vec3d{0.5, 0.5, -0.2}, Vec3d{0.5, 0.5, 0.2}}));
  EXPECT_TRUE(triangles_cross({a, b, c}, {a, Vec3d{3, 1, 0}, Vec3d{1, 3, 0}}));
}

TEST(Crossings, AgreeWithDistancesOfRandomTriangles) {
  core::Random random(9);
  int crossed = 0;
  for (int round = 0; round < 3000; ++round) {
    TriangleCorners p{random_place(random), random_place(random), random_place(random)}, q = p;
    for (Vec3d& corner : q) corner = random_place(random);
    double nearest = 1e9;
    for (std::size_t k = 0; k < 3; ++k) {
      nearest = std::min(nearest, closest_segment_triangle(p[k], p[(k + 1) % 3], q[0], q[1], q[2]).distance2);
      nearest = std::min(nearest, closest_segment_triangle(q[k], q[(k + 1) % 3], p[0], p[1], p[2]).distance2);
    }
    EXPECT_EQ(triangles_cross(p, q), nearest < 1e-20) << nearest;
    crossed += triangles_cross(p, q);
  }
  EXPECT_GT(crossed, 300);
}

TEST(Crossings, ABallCrossesItselfNowhereAndTwoBallsWhereTheyMeet) {
  EXPECT_TRUE(self_crossings(sphere_mesh(0.03, 4)).pairs.empty());
  TriMesh two = sphere_mesh(1, 3);
  const int half = int(two.positions.size()), triangles = int(two.triangles.size());
  for (int v = 0; v < half; ++v) two.positions.push_back(two.positions[v] + Vec3d{0.9, 0.05, 0.02});
  for (int t = 0; t < triangles; ++t) {
    const auto& [a, b, c] = two.triangles[t];
    two.triangles.push_back({a + half, b + half, c + half});
  }
  const Crossings found = self_crossings(two);
  EXPECT_TRUE(found.all);
  EXPECT_GT(found.pairs.size(), 30u);
  for (const auto& [a, b] : found.pairs) {
    EXPECT_TRUE(a < triangles && b >= triangles);
    EXPECT_NEAR(two.positions[two.triangles[a][0]].x, 0.45, 0.25);
  }
}

TEST(Crossings, HostileMeshesBoundTheSearch) {
  core::Random random(2);
  TriMesh mesh;
  for (int t = 0; t < 3000; ++t) {
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(random_place(random));
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  const Crossings found = self_crossings(mesh);
  EXPECT_FALSE(found.all);
  EXPECT_EQ(int(found.pairs.size()), kMostCrossings);
  mesh.positions[0].x = std::nan("");
  EXPECT_EQ(self_crossings({mesh.positions, {{0, 1, 2}, {0, 0, 1}}}).pairs.size(), 0u);
}

}  // namespace trocar::geometry
