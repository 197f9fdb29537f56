#include <cmath>
#include <cstdio>
#include <stdexcept>

#include <gtest/gtest.h>

#include <trocar/core/hash.hpp>
#include <trocar/core/random.hpp>
#include <trocar/geometry/loft.hpp>
#include <trocar/geometry/nearest.hpp>
#include <trocar/geometry/stuffing.hpp>

#include "shapes.hpp"

namespace trocar::geometry {
namespace {

Field ball(double radius, Vec3d centre = {}) {
  const Vec3d r{radius, radius, radius};
  return {[=](Vec3d p) { return radius - length(p - centre); }, {centre - r, centre + r}};
}
Field torus(double around, double thick) {
  const double r = around + thick;
  return {[=](Vec3d p) {
            const double ring = std::sqrt(p.x * p.x + p.y * p.y) - around;
            return thick - std::sqrt(ring * ring + p.z * p.z);
          },
          {{-r, -r, -thick}, {r, r, thick}}};
}
Field rod(double length_of, double radius) {
  const Vec3d a{0, 0, 0}, b{0.6 * length_of, 0.48 * length_of, 0.64 * length_of};
  const Vec3d r{radius, radius, radius};
  return {[=](Vec3d p) { return radius - length(p - (a + closest_on_segment(p, a, b) * (b - a))); }, {a - r, b + r}};
}

/// The uterus of the scenes, about.
TriMesh uterus(double edge) {
  const auto section = [](double y, double z, double across, double deep_y, double deep_z, double squareness) {
    return Section{1e-3 * Vec3d{0, y, z}, 1e-3 * Vec3d{across, 0, 0}, 1e-3 * Vec3d{0, deep_y, deep_z}, squareness};
  };
  const std::vector<Section> sections{
      section(-159.2, -106.8, 25.1, -12.1, 9.5, 2.2), section(-162, -110.4, 24.2, -12.8, 10, 2.2),
      section(-165.3, -114.7, 20.9, -13.2, 9.7, 2.1), section(-168.8, -119.6, 17.4, -12.9, 8.8, 2),
      section(-172.6, -125.5, 14.2, -11.8, 7.3, 2),   section(-176.1, -131.6, 12.4, -11, 6.2, 2),
      section(-179.4, -137.7, 12.1, -10.9, 5.5, 2),   section(-182, -143.1, 12.5, -11.2, 5.1, 2),
      section(-184.1, -147.7, 12.5, -11.1, 5, 2)};
  return tessellate(loft(sections), edge);
}

void expect_good_body(const TetMesh& body, const StuffingReport& report) {
  const TetFacts facts = inspect(body, 0);
  EXPECT_EQ(facts.inverted + facts.flat + facts.duplicate_cells + facts.unused_nodes + facts.overlapping_faces, 0);
  EXPECT_EQ(facts.crowded_faces, 0);
  EXPECT_EQ(report.odd_edges, 0);
  EXPECT_EQ(report.parts, 1);
  EXPECT_TRUE(check_edges(surface_of(body).mesh).closed());
  EXPECT_GE(report.least_dihedral, kStuffedLeastDihedral);
  EXPECT_LE(report.most_dihedral, kStuffedMostDihedral);
}

double order(double coarse, double fine) { return std::log2(coarse / fine); }

}  // namespace

TEST(Stuffing, BallsAreClosedWellShapedAndTheirVolumeConvergesWithOrderTwo) {
  const double r = 0.03, exact = 4.0 / 3 * M_PI * r * r * r;
  double last = 0, last_off = 0;
  for (const double cell : {0.012, 0.006, 0.003, 0.0015}) {
    const Field field = ball(r, {0.001, 0.0007, -0.0004});
    const TetMesh body = stuffed(field, cell, {1'000'000});
    const StuffingReport report = compare(body, field);
    expect_good_body(body, report);
    EXPECT_LT(report.nodes_off, 1e-8 * cell);
    const double error = std::fabs(report.volume - exact) / exact;
    std::printf("cell %.1f mm: %6d cells, angles %.2f to %.2f, volume off %.4f %% (order %.2f), surface off %.4f mm "
                "(order %.2f)\n",
                1e3 * cell, report.cells, report.least_dihedral, report.most_dihedral, 100 * error,
                last > 0 ? order(last, error) : 0.0, 1e3 * report.surface_off,
                last > 0 ? order(last_off, report.surface_off) : 0.0);
    if (last > 0) {
      EXPECT_NEAR(order(last, error), 2, 0.4);
      EXPECT_NEAR(order(last_off, report.surface_off), 2, 0.6);
    }
    last = error;
    last_off = report.surface_off;
  }
}

TEST(Stuffing, ATorusKeepsItsHole) {
  const Field field = torus(0.03, 0.01);
  const TetMesh body = stuffed(field, 0.004);
  const StuffingReport report = compare(body, field);
  expect_good_body(body, report);
  const TriMesh surface = surface_of(body).mesh;
  const int vertices = int(surface.positions.size()), faces = int(surface.triangles.size());
  EXPECT_EQ(vertices - int(edges(surface).size()) + faces, 0) << "Euler's number of a torus";
  EXPECT_NEAR(report.volume / (2 * M_PI * M_PI * 0.03 * 0.01 * 0.01), 1, 0.03);
}

TEST(Stuffing, TheLoftedUterusBecomesABody) {
  const TriMesh shape = uterus(0.0015);
  double last = 0;
  for (const double cell : {0.0068, 0.0034, 0.0017}) {
    const TetMesh body = stuffed(shape, cell);
    const ShapeReport report = compare(body, shape);
    expect_good_body(body, report);
    EXPECT_LT(report.nodes_off, 1e-6 * cell);
    const double error = 1 - report.volume / report.shape_volume;
    std::printf("cell %.1f mm: %5d nodes, %6d cells, angles %.2f to %.2f, volume off %.3f %%, surface off %.3f and "
                "%.3f mm\n",
                1e3 * cell, report.nodes, report.cells, report.least_dihedral, report.most_dihedral, 100 * error,
                1e3 * report.surface_off, 1e3 * report.shape_off);
    if (last > 0) EXPECT_GT(order(last, error), 1.5);
    last = error;
  }
  EXPECT_LT(last, 0.005);
}

TEST(Stuffing, SharpEdgesAreCutOffByLessThanHalfACube) {
  const TriMesh box = box_mesh({0.04, 0.03, 0.02});
  TriMesh turned = box;
  const Mat3d frame{{{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}}};
  for (Vec3d& p : turned.positions) p = frame * p;
  for (const TriMesh& shape : {box, turned})
    for (const double cell : {0.004, 0.002}) {
      const TetMesh body = stuffed(shape, cell);
      const ShapeReport report = compare(body, shape);
      expect_good_body(body, report);
      std::printf("cell %.0f mm: corners off %.2f mm, surface off %.2f mm, volume off %.2f %%\n", 1e3 * cell,
                  1e3 * report.shape_off, 1e3 * report.surface_off,
                  100 * (1 - report.volume / report.shape_volume));
      EXPECT_LT(report.shape_off, 0.75 * cell) << "a corner of three edges";
      EXPECT_LT(report.surface_off, 0.5 * cell);
      EXPECT_NEAR(report.volume / report.shape_volume, 1, 0.1 * cell / 0.002 * 0.25);
    }
}

TEST(Stuffing, WhatFacesFitTheLatticeIsExact) {
  const TetMesh body = stuffed(box_mesh({0.04, 0.03, 0.02}), 0.005);
  EXPECT_NEAR(inspect(body).volume, 24e-6, 0.02 * 24e-6);  // but for the edges
}

TEST(Stuffing, ARodHoldsTogetherDownToTwoThirdsOfACubeThickAndIsReportedWhereNot) {
  for (const double share : {2.0, 1.5, 1.0, 0.8, 0.6, 0.4}) {  // thickness in cubes
    const double cell = 0.003;
    const Field field = rod(0.06, 0.5 * share * cell);
    int parts = 0, odd = 0;
    double volume_of = 0, least = 180;
    try {
      const StuffingReport report = compare(stuffed(field, cell), field);
      parts = report.parts;
      odd = report.odd_edges;
      volume_of = report.volume;
      least = report.least_dihedral;
    } catch (const std::invalid_argument&) {
    }
    std::printf("rod of %.1f cubes: %d parts, %d odd edges, volume %.2f of it, least angle %.2f\n", share, parts, odd,
                volume_of / (M_PI * 0.25 * share * share * cell * cell * (0.06 + 2.0 / 3 * share * cell)), least);
  }
}

}  // namespace trocar::geometry
