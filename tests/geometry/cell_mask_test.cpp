#include <cmath>

#include <gtest/gtest.h>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/geometry/volumes/cell_mask.hpp>

namespace trocar::geometry {
namespace {

/// A cube with corners at low and high.
struct Cube {
  std::vector<Vec3f> points;
  std::vector<std::array<int, 3>> triangles;

  Cube(Vec3f low, Vec3f high) {
    for (int i = 0; i < 8; ++i)
      points.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
    const int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& q : quads) {
      triangles.push_back({q[0], q[1], q[2]});
      triangles.push_back({q[0], q[2], q[3]});
    }
  }
};

int count(const CellMask& mask) {
  int n = 0;
  for (int k = 0; k < mask.count[2]; ++k)
    for (int j = 0; j < mask.count[1]; ++j)
      for (int i = 0; i < mask.count[0]; ++i) n += mask.at(mask.first[0] + i, mask.first[1] + j, mask.first[2] + k);
  return n;
}

TEST(CellMask, ACubeHoldsTheCellsWhoseMiddlesLieInIt) {
  const Cube cube({-1, 0, 2}, {3, 2, 5});
  const CellMask mask = cells_inside(cube.points, cube.triangles, 0.5);
  EXPECT_EQ(count(mask), 8 * 4 * 6);
  EXPECT_TRUE(mask.at(-2, 0, 4));
  EXPECT_FALSE(mask.at(-3, 0, 4));
  EXPECT_FALSE(mask.at(6, 0, 4));
  EXPECT_FALSE(mask.at(1000, 1000, 1000));
}

TEST(CellMask, LinesThroughEdgesAndCornersAreCountedOnce) {
  // Middles of cells lie exactly on edges and diagonals of the faces.
  const Cube cube({0.25f, 0.25f, 0.25f}, {4.25f, 4.25f, 4.25f});
  const CellMask mask = cells_inside(cube.points, cube.triangles, 0.5);
  const int n = count(mask);
  EXPECT_GE(n, 8 * 8 * 8);
  EXPECT_LE(n, 9 * 9 * 9);
  for (int i = 1; i < 8; ++i) EXPECT_TRUE(mask.at(i, i, i)) << i;
}

TEST(CellMask, WhatIsInsideOutHoldsNothing) {
  Cube cube({0, 0, 0}, {2, 2, 2});
  for (auto& t : cube.triangles) std::swap(t[0], t[1]);
  EXPECT_EQ(count(cells_inside(cube.points, cube.triangles, 0.5)), 0);
}

TEST(CellMask, NearATriangleIsWhatIsWithinReach) {
  const std::vector<Vec3f> points{{0, 0, 0}, {4, 0, 0.3f}, {0, 3, 1}};
  const std::vector<std::array<int, 3>> triangles{{0, 1, 2}};
  const double cell = 0.25, reach = 0.4;
  const CellMask mask = cells_near(points, triangles, cell, reach);
  for (int k = -4; k < 8; ++k)
    for (int j = -4; j < 16; ++j)
      for (int i = -4; i < 20; ++i) {
        const Vec3d middle = cell * Vec3d{i + 0.5, j + 0.5, k + 0.5};
        const double far2 = closest_on_triangle(middle, vec_cast<double>(points[0]), vec_cast<double>(points[1]),
                                                vec_cast<double>(points[2]))
                                .distance2;
        EXPECT_EQ(mask.at(i, j, k), far2 <= reach * reach) << i << ' ' << j << ' ' << k;
      }
}

}  // namespace
}  // namespace trocar::geometry
