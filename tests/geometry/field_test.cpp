#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/geometry/volumes/field.hpp>

#include "shapes.hpp"

namespace trocar::geometry {
namespace {

Vec3d random_point(core::Random& random, double range) {
  const double x = random.uniform(-range, range), y = random.uniform(-range, range), z = random.uniform(-range, range);
  return {x, y, z};
}

/// How often the surface goes around p, from solid angles [van Oosterom & Strackee 1983]: slow, and another way.
double turns(const TriMesh& mesh, Vec3d p) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3d a = mesh.positions[t[0]] - p, b = mesh.positions[t[1]] - p, c = mesh.positions[t[2]] - p;
    const double la = length(a), lb = length(b), lc = length(c);
    sum += 2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return sum / (4 * std::numbers::pi);
}
double searched_distance(const TriMesh& mesh, Vec3d p) {
  double best = 1e9;
  for (const auto& t : mesh.triangles)
    best = std::min(best,
                    closest_on_triangle(p, mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]).distance2);
  return std::sqrt(best);
}
TriMesh joined(TriMesh a, const TriMesh& b, Vec3d shift) {
  const int n = int(a.positions.size());
  for (const Vec3d p : b.positions) a.positions.push_back(p + shift);
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  return a;
}

/// A ball of voxels with the value `label`, radius and centre in voxels, in a volume of n^3.
Voxels voxel_ball(int n, double radius, Vec3d centre, std::uint8_t label, double side) {
  Voxels v;
  v.size = {n, n, n};
  v.step = {{{side, 0, 0}, {0, side, 0}, {0, 0, side}}};
  std::vector<std::uint8_t> values;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        values.push_back(length(Vec3d{double(i), double(j), double(k)} - centre) < radius ? label : 0);
  v.values = values;
  return v;
}
/// Along a ray from inside, where the field is 0.
double edge_along(const Field& field, Vec3d from, Vec3d direction, double far) {
  double low = 0, high = far;
  for (int i = 0; i < 60; ++i) {
    const double s = 0.5 * (low + high);
    (field.inside(from + s * direction) > 0 ? low : high) = s;
  }
  return low;
}

}  // namespace

TEST(Field, OfAMeshIsTheDistanceThatASearchFindsWithTheSignOfTheSolidAngle) {
  core::Random random(5);
  const TriMesh sphere = sphere_mesh(0.03, 3), box = box_mesh({0.04, 0.03, 0.02});
  const TriMesh overlapping = joined(sphere, sphere, {0.02, 0.01, 0.005}), apart = joined(sphere, box, {0.05, 0, 0});
  for (const TriMesh& mesh : {sphere, box, overlapping, apart}) {
    const Field field = field_of(mesh);
    for (int i = 0; i < 600; ++i) {
      const Vec3d p = random_point(random, i % 2 ? 0.05 : 0.1);
      const double distance = searched_distance(mesh, p);
      if (distance < 1e-9) continue;
      ASSERT_NEAR(field.inside(p), turns(mesh, p) > 0.5 ? distance : -distance, 1e-12) << i;
    }
  }
}

TEST(Field, ThroughVerticesAndEdgesNoSignIsLost) {
  TriMesh mesh = sphere_mesh(0.5, 2);  // with vertices and edges above each other and upright triangles below
  const Field field = field_of(mesh);
  for (const Vec3d vertex : mesh.positions)
    for (const double z : {-0.6, -0.2, 0.0, 0.3, 0.6}) {
      const Vec3d p{0.999999 * vertex.x, 0.999999 * vertex.y, z}, exactly{vertex.x, vertex.y, z};
      for (const Vec3d q : {p, exactly}) {
        const double distance = searched_distance(mesh, q);
        if (distance < 1e-8) continue;
        EXPECT_EQ(field.inside(q) > 0, turns(mesh, q) > 0.5) << q.x << ' ' << q.y << ' ' << q.z;
      }
    }
  const Field box = field_of(box_mesh({1, 1, 1}));
  for (int i = -1; i <= 5; ++i)
    for (int j = -1; j <= 5; ++j)
      for (int k = -1; k <= 5; ++k) {
        const auto within = [](int n) { return n > 0 && n < 4; };
        const auto touching = [](int n) { return n >= 0 && n <= 4; };
        const double f = box.inside({0.25 * i, 0.25 * j, 0.25 * k});
        if (within(i) && within(j) && within(k)) {
          EXPECT_GT(f, 0.2);
        } else if (!(touching(i) && touching(j) && touching(k))) {
          EXPECT_LT(f, -0.2);
        }
      }
}

TEST(Field, OfNeedlesCostsNoMoreThanOfOthers) {
  TriMesh fan;  // a double cone of 20000 needles, each as long as the box, upright and lying
  constexpr int n = 10000;
  fan.positions = {{0, 0, 1}, {0, 0, -1}};
  for (int i = 0; i < n; ++i)
    fan.positions.push_back({std::cos(2 * std::numbers::pi * i / n), std::sin(2 * std::numbers::pi * i / n), 0});
  for (int i = 0; i < n; ++i) {
    fan.triangles.push_back({0, 2 + i, 2 + (i + 1) % n});
    fan.triangles.push_back({1, 2 + (i + 1) % n, 2 + i});
  }
  for (Vec3d& p : fan.positions) p = {p.x, p.z, p.y};
  for (auto& t : fan.triangles) std::swap(t[0], t[1]);
  const Field field = field_of(fan);
  core::Random random(9);
  for (int i = 0; i < 200; ++i) {
    const Vec3d p = random_point(random, 1.1);
    const double depth = (1 - std::fabs(p.y) - std::sqrt(p.x * p.x + p.z * p.z)) / std::sqrt(2.0);
    if (std::fabs(depth) > 1e-3) {
      EXPECT_EQ(field.inside(p) > 0, depth > 0) << i;
    }
  }
}

TEST(Field, MeshesWithoutAnInsideAreRefused) {
  TriMesh open = sphere_mesh(0.03, 1), inverted = sphere_mesh(0.03, 1);
  open.triangles.pop_back();
  for (auto& t : inverted.triangles) std::swap(t[0], t[1]);
  EXPECT_THROW(field_of(open), std::invalid_argument);
  EXPECT_THROW(field_of(inverted), std::invalid_argument);
  EXPECT_THROW(field_of(TriMesh{}), std::invalid_argument);
  EXPECT_THROW(distance_to(TriMesh{}), std::invalid_argument);
}

TEST(Field, ALabelsFlatFacesStayMidwayBetweenVoxelsHoweverSmooth) {
  Voxels v;
  v.size = {20, 20, 20};
  v.origin = {0.1, -0.2, 0.3};
  v.step = {{{0, 0, 0.003}, {0.001, 0, 0}, {0, 0.002, 0}}};  // turned, and longer along the second and third axis
  std::vector<std::int16_t> values(v.count());
  for (int k = 0; k < 20; ++k)
    for (int j = 0; j < 20; ++j)
      for (int i = 0; i < 20; ++i)
        values[v.index(i, j, k)] = i >= 4 && i < 16 && j >= 4 && j < 16 && k >= 4 && k < 16 ? -7 : 3;
  v.values = values;
  for (const int smoothing : {0, 1, 2, 4}) {
    const Field field = field_of_label(v, -7, smoothing);
    const Vec3d middle = v.centre({9.5, 9.5, 9.5});
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3d along = v.step.column(axis);
      EXPECT_NEAR(edge_along(field, middle, along, 9), 6, 1e-5) << "voxels: the face is midway between 15 and 16";
      const double slope = field.inside(middle + 5.75 * along) - field.inside(middle + 6.25 * along);
      EXPECT_NEAR(slope / 0.001, 1, 0.01) << "half a mean step of 2 mm over half a voxel";
    }
    EXPECT_LT(field.inside(middle + Vec3d{1, 1, 1}), 0);
  }
}

TEST(Field, SmoothingABallCostsWhatTheHeaderSays) {
  const double radius = 10;
  const Vec3d centre{15.3, 14.8, 15.1};
  const Voxels v = voxel_ball(31, radius, centre, 5, 0.001);
  core::Random random(6);
  double means[4] = {};
  for (const int smoothing : {0, 1, 2, 3}) {
    const Field field = field_of_label(v, 5, smoothing);
    double sum = 0, rough = 0;
    constexpr int rays = 4000;
    for (int i = 0; i < rays; ++i) {
      const double at = edge_along(field, v.centre(centre), normalised(random_point(random, 1)), 0.02) / 0.001;
      sum += at / rays;
      rough = std::max(rough, std::fabs(at - radius));
    }
    means[smoothing] = sum;
    EXPECT_LT(rough, smoothing == 0 ? 1.0 : 0.6) << smoothing;
  }
  for (const int smoothing : {1, 2, 3}) EXPECT_NEAR(means[smoothing], radius - 0.5 * smoothing / radius, 0.06);
}

TEST(Field, AThresholdCutsBetweenVoxelsWhereTheValueIs) {
  Voxels v;
  v.size = {24, 24, 24};
  std::vector<float> values;
  const Vec3d centre{11.3, 11.6, 11.9};
  for (int k = 0; k < 24; ++k)
    for (int j = 0; j < 24; ++j)
      for (int i = 0; i < 24; ++i)
        values.push_back(float(100 - 10 * length(Vec3d{double(i), double(j), double(k)} - centre)));
  v.values = values;
  const Field field = field_above(v, 20);  // a ball of radius 8
  core::Random random(7);
  for (int i = 0; i < 300; ++i) EXPECT_NEAR(edge_along(field, centre, normalised(random_point(random, 1)), 20), 8, 0.1);
}

TEST(Field, WhatTheVolumesBorderCutsEndsThere) {
  Voxels v = voxel_ball(11, 100, {5, 5, 5}, 1, 1.0);  // full
  const Field field = field_of_label(v, 1, 1);
  EXPECT_GT(field.inside({5, 5, 5}), 0);
  EXPECT_NEAR(edge_along(field, {5, 5, 5}, {1, 0, 0}, 50), 5.5, 1e-6);
  std::vector<float> values(v.count(), 3.0f);
  v.values = values;
  EXPECT_NEAR(edge_along(field_above(v, 1), {5, 5, 5}, {0, -1, 0}, 50), 5.5, 1e-6);
}

TEST(Field, WithoutVoxelsThereIsNone) {
  const Voxels v = voxel_ball(5, 2, {2, 2, 2}, 5, 1);
  EXPECT_THROW(field_of_label(v, 6), std::invalid_argument);
  EXPECT_THROW(field_of_label(v, 5, -1), std::invalid_argument);
  EXPECT_THROW(field_of_label(v, 5, 17), std::invalid_argument);
  EXPECT_THROW(field_above(v, 5), std::invalid_argument);
  Voxels flat = v;
  flat.step = {};
  EXPECT_THROW(field_of_label(flat, 5), std::invalid_argument);
}

}  // namespace trocar::geometry
