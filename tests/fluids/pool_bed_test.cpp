// The pool's bed under triangles.
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/fluids/pool_bed.hpp>

namespace trocar::fluids {
namespace {

constexpr float kNone = -1;

struct Field {
  PoolModel pool;
  std::vector<float> bed;
  Field() {
    PoolDescription d;
    d.nx = 20;
    d.ny = 16;
    d.cell = 0.002;
    d.origin = {0.01, -0.02, 0.03};
    d.u = {0, 1, 0};
    d.v = {0, 0, 1};  // up is x
    pool = build(d);
    bed.assign(20 * 16, kNone);
  }
  float& at(int i, int j) { return bed[size_t(j) * 20 + size_t(i)]; }
  /// A point over place (i, j) in cells.
  Vec3d over(double i, double j, double height) { return in_cells(pool, world(pool, 0.002 * i, 0.002 * j, height)); }
  int raised() const {
    int n = 0;
    for (const float h : bed) n += h != kNone;
    return n;
  }
};

double slope(double i, double j) { return 0.004 + 0.0003 * i - 0.0002 * j; }

TEST(PoolBed, ASquareOfTwoTrianglesRaisesEachOfItsCellsOnceToItsPlane) {
  Field f;
  const auto corner = [&](double i, double j) { return f.over(i, j, slope(i, j)); };
  raise_bed(f.pool, {corner(3, 4), corner(11, 4), corner(11, 10)}, 0, 16, f.bed);
  raise_bed(f.pool, {corner(3, 4), corner(11, 10), corner(3, 10)}, 0, 16, f.bed);
  EXPECT_EQ(f.raised(), 8 * 6);
  for (int j = 4; j < 10; ++j)
    for (int i = 3; i < 11; ++i) EXPECT_NEAR(f.at(i, j), slope(i + 0.5, j + 0.5), 1e-8) << i << ' ' << j;
}

TEST(PoolBed, TheHigherOfTwoSurfacesCountsInAnyOrder) {
  Field f;
  for (const double height : {0.005, 0.009, 0.002})
    raise_bed(f.pool, {f.over(0, 0, height), f.over(10, 0, height), f.over(0, 10, height)}, 0, 16, f.bed);
  EXPECT_FLOAT_EQ(f.at(2, 2), 0.009f);
}

TEST(PoolBed, OnlyTheRowsThatAreAskedForChange) {
  Field f;
  raise_bed(f.pool, {f.over(-50, -50, 0.01), f.over(100, -50, 0.01), f.over(-50, 100, 0.01)}, 4, 8, f.bed);
  EXPECT_EQ(f.raised(), 20 * 4);
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(f.at(i, 3) == kNone && f.at(i, 4) != kNone && f.at(i, 8) == kNone);
}

TEST(PoolBed, WhatLooksDownStandsUprightOrIsNotFiniteRaisesNothing) {
  Field f;
  const Vec3d a = f.over(2, 2, 0.01), b = f.over(9, 2, 0.01), c = f.over(2, 9, 0.01);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
  raise_bed(f.pool, {a, c, b}, 0, 16, f.bed);
  raise_bed(f.pool, {a, b, f.over(5, 2, 0.05)}, 0, 16, f.bed);
  for (const double odd : {kNan, kInf, -kInf, 1e300})
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d p = c;
      p[axis] = odd;
      raise_bed(f.pool, {a, b, p}, 0, 16, f.bed);
      raise_bed(f.pool, {p, a, b}, 0, 16, f.bed);
    }
  for (const float h : f.bed) EXPECT_TRUE(std::isfinite(h));
  EXPECT_EQ(f.raised(), 0);
}

}  // namespace
}  // namespace trocar::fluids
