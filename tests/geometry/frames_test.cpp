#include <vector>

#include <gtest/gtest.h>

#include <trocar/geometry/curves/frames.hpp>
#include <trocar/numerics/portable.hpp>

using namespace trocar;
using namespace trocar::geometry;

namespace {

void expect_orthonormal(const std::vector<Frame>& frames) {
  for (const Frame& f : frames) {
    EXPECT_NEAR(length(f.tangent), 1, 1e-14);
    EXPECT_NEAR(length(f.normal), 1, 1e-14);
    EXPECT_NEAR(dot(f.tangent, f.normal), 0, 1e-14);
    EXPECT_LT(length(f.binormal - cross(f.tangent, f.normal)), 1e-14);
  }
}

}  // namespace

TEST(Frames, KeepTheNormalOfAPlaneCurveThroughInflections) {
  std::vector<Vec3d> points;
  for (int i = 0; i <= 200; ++i) points.push_back({0.01 * i, portable::sin(0.1 * i), 0});
  std::vector<Frame> frames(points.size());
  transport_frames(points, {0, 0, 1}, frames);
  expect_orthonormal(frames);
  for (const Frame& f : frames) EXPECT_LT(length(f.normal - Vec3d{0, 0, 1}), 1e-12);
}

TEST(Frames, TurnAgainstTheTorsionOfAHelixByItsClosedForm) {
  // Relative to the Frenet frame a rotation minimising one turns by minus the integral of the torsion.
  const double radius = 1.0, rise = 0.5, turns = 3.0;
  const int n = 3000;
  std::vector<Vec3d> points;
  for (int i = 0; i <= n; ++i) {
    const double a = 2 * portable::pi * turns * i / n;
    points.push_back({radius * portable::cos(a), radius * portable::sin(a), rise * a});
  }
  std::vector<Frame> frames(points.size());
  transport_frames(points, {-1, 0, 0}, frames);  // Frenet's normal at the start
  expect_orthonormal(frames);
  const double speed2 = radius * radius + rise * rise;
  const double turned = -rise / speed2 * std::sqrt(speed2) * 2 * portable::pi * turns;
  const Vec3d frenet_normal{-1, 0, 0};  // also at the end: whole turns
  const Frame& last = frames.back();
  const double angle =
      portable::atan2(dot(last.tangent, cross(frenet_normal, last.normal)), dot(frenet_normal, last.normal));
  const double difference = angle - turned;
  const double whole = std::floor(difference / (2 * portable::pi) + 0.5) * 2 * portable::pi;
  EXPECT_NEAR(difference, whole, 2e-3);
}

TEST(Frames, SurviveRepeatedPointsReversalsAndANormalAlongTheLine) {
  const std::vector<Vec3d> points{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0},
                                  {2, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 0}};
  std::vector<Frame> frames(points.size());
  transport_frames(points, {1, 0, 0}, frames);
  expect_orthonormal(frames);
  std::vector<Frame> one(1);
  transport_frames(std::vector<Vec3d>{{1, 2, 3}}, {0, 0, 1}, one);
  expect_orthonormal(one);
}

TEST(Frames, TangentsPointAlongTheLine) {
  const std::vector<Vec3d> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  std::vector<Vec3d> tangents(3);
  line_tangents(points, tangents);
  EXPECT_EQ(tangents[0], (Vec3d{1, 0, 0}));
  EXPECT_LT(length(tangents[1] - normalised(Vec3d{1, 1, 0})), 1e-15);
  EXPECT_EQ(tangents[2], (Vec3d{0, 1, 0}));
}
