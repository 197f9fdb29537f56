// Cameras, matrices, normals and the openness bake.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/render/frame/frame.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/render/meshes/openness.hpp>
#include <trocar/render/meshes/patterns.hpp>

#include "sample_scene.hpp"

namespace trocar::render {
namespace {

void expect_near(Vec3f a, Vec3f b) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-5f);
}

TEST(Camera, LookAtPutsTheTargetStraightAhead) {
  const Camera camera = look_at({1, 2, 3}, {1, 5, 3}, {0, 0, 1});
  const Vec3f seen = transform_point(view_matrix(camera.rotation, camera.position), {1, 5, 3});
  expect_near(seen, {0, 0, -3});
  const Vec3f above = transform_point(view_matrix(camera.rotation, camera.position), {1, 5, 4});
  EXPECT_GT(above.y, 0.9f);
}

TEST(Camera, AnAngledScopeLooksUpFromItsShaftAndRollTurnsThat) {
  constexpr float angle = 0.5235988f;  // 30 degrees
  const Camera straight = at_scope_tip({0, 0, 0}, Mat3f::identity(), 0, 0);
  expect_near(straight.rotation.column(2), {0, 0, 1});
  const Camera up = at_scope_tip({0, 0, 0}, Mat3f::identity(), angle, 0);
  expect_near(-up.rotation.column(2), {0, std::sin(angle), -std::cos(angle)});
  const Camera rolled = at_scope_tip({0, 0, 0}, Mat3f::identity(), angle, 1.5707963f);
  expect_near(-rolled.rotation.column(2), {-std::sin(angle), 0, -std::cos(angle)});
  EXPECT_NEAR(rolled.rotation.column(0).y, 0, 1e-5f);  // the head stays upright
}

TEST(Mat4, PerspectiveMapsNearAndFarToTheClipEnds) {
  const Mat4 p = perspective(1.0f, 1.5f, 0.01f, 0.5f);
  for (auto [distance, expected] : {std::pair{0.01f, -1.0f}, std::pair{0.5f, 1.0f}}) {
    const float z = p.m[10] * -distance + p.m[14], w = distance;
    EXPECT_NEAR(z / w, expected, 1e-4f);
  }
}

TEST(Colour, SrgbEndsAndMiddle) { expect_near(srgb(0, 255, 188), {0, 1, 0.502886f}); }

TEST(MeshArrays, NormalsOfABallPointOutward) {
  const sample::Shape ball = sample::sphere({0, 0, 0}, 1, 24);
  std::vector<Vec3f> normals;
  vertex_normals(ball.positions, ball.triangles, normals);
  int good = 0;
  for (std::size_t i = 0; i < normals.size(); ++i) good += dot(normals[i], normalised(ball.positions[i])) > 0.97f;
  EXPECT_GT(good, int(normals.size()) - 60);  // all but the poles' doubled vertices
}

TEST(Openness, AnOpenBallIsOpenAndTheInsideOfABallIsNot) {
  const sample::Shape small = sample::sphere({0, 0, 0}, 0.01f, 20), large = sample::sphere({0, 0, 0}, 0.02f, 40);
  const auto mean = [](const std::vector<Paint>& paint) {
    double sum = 0;
    for (Paint p : paint) sum += p.openness;
    return sum / double(paint.size());
  };
  std::vector<Vec3f> normals;
  vertex_normals(small.positions, small.triangles, normals);
  std::vector<Paint> paint = small.paint;
  const std::vector<Occluder> alone{{small.positions, small.triangles}};
  OpennessBaker(alone).bake(small.positions, normals, paint);
  EXPECT_GT(mean(paint), 235);
  const std::vector<Occluder> wrapped{{small.positions, small.triangles}, {large.positions, large.triangles}};
  OpennessBaker(wrapped).bake(small.positions, normals, paint);
  EXPECT_LT(mean(paint), 110);
}

TEST(Openness, EvenedOutHasNoTeethAndKeepsItsMean) {
  const sample::Shape strip = sample::sheet(40, 1, [](float u, float v) { return Vec3f{u, v, 0}; });
  std::vector<Paint> paint(strip.positions.size());
  for (std::size_t i = 0; i < paint.size(); ++i)
    paint[i].openness = strip.positions[i].y > 0.5f && i % 2 == 0 ? 40 : 240;
  const auto range = [&] {
    int low = 255, high = 0;
    for (const Paint p : paint) low = std::min<int>(low, p.openness), high = std::max<int>(high, p.openness);
    return high - low;
  };
  const auto mean = [&] {
    double sum = 0;
    for (const Paint p : paint) sum += p.openness / double(paint.size());
    return sum;
  };
  const double before = mean();
  ASSERT_GT(range(), 150);
  even_openness(strip.triangles, paint, 8);
  EXPECT_LT(range(), 60);
  EXPECT_NEAR(mean(), before, 15);
}

TEST(Patterns, AreTheSameEveryTimeAndTile) {
  const Pattern noise = noise_pattern();
  EXPECT_EQ(noise.texels, noise_pattern().texels);
  // Across the seam the value changes no more than inside.
  const auto value = [&](int i, int j, int k) { return int(noise.texels[4 * (i + 64 * (j + 64 * k)) + 3]); };
  int inside = 0, seam = 0;
  for (int j = 0; j < 64; ++j)
    for (int k = 0; k < 64; ++k) {
      inside = std::max(inside, std::abs(value(31, j, k) - value(32, j, k)));
      seam = std::max(seam, std::abs(value(63, j, k) - value(0, j, k)));
    }
  EXPECT_LE(seam, inside + 12);
}

TEST(Patterns, VesselsCoverAFairShareAndNoMore) {
  const Pattern vessels = vessel_pattern();
  std::size_t red = 0, blue = 0;
  for (std::size_t i = 0; i < vessels.texels.size(); i += 2) {
    red += vessels.texels[i] > 60;
    blue += vessels.texels[i + 1] > 60;
  }
  const double n = double(vessels.texels.size() / 2);
  EXPECT_GT(double(red) / n, 0.02);
  EXPECT_LT(double(red) / n, 0.2);
  EXPECT_GT(double(blue) / n, 0.02);
  EXPECT_LT(double(blue) / n, 0.35);
}

TEST(MeshArrays, EachEdgeOfTheTrianglesIsListedOnce) {
  const std::vector<std::uint32_t> two{0, 1, 2, 2, 1, 3};
  EXPECT_EQ(edges_of(two), (std::vector<std::uint32_t>{0, 1, 0, 2, 1, 2, 1, 3, 2, 3}));
  EXPECT_TRUE(edges_of({}).empty());
}

}  // namespace
}  // namespace trocar::render
