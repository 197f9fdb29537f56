#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include <trocar/geometry/surfaces/point_grid.hpp>

namespace trocar::geometry {
namespace {

/// A cloud without order, 0.2 m wide.
std::vector<Vec3f> cloud() {
  std::vector<Vec3f> points;
  for (int i = 0; i < 400; ++i) {
    const float t = float(i);
    points.push_back({0.1f * std::sin(12.9f * t), 0.1f * std::sin(78.2f * t), 0.1f * std::sin(37.7f * t)});
  }
  return points;
}

TEST(PointGrid, VisitsAllThatAreNearOnce) {
  const std::vector<Vec3f> points = cloud();
  const PointGrid grid(points, 0.013f);
  for (const Vec3f p : {Vec3f{0, 0, 0}, Vec3f{0.09f, -0.1f, 0.03f}, Vec3f{0.3f, 0, 0}})
    for (const float reach : {0.0f, 0.02f, 0.3f}) {
      std::set<std::uint32_t> visited;
      grid.visit(p, reach, [&](std::uint32_t i) { EXPECT_TRUE(visited.insert(i).second); });
      for (std::uint32_t i = 0; i < points.size(); ++i)
        EXPECT_TRUE(length(points[i] - p) > reach || visited.count(i)) << i;
    }
}

TEST(PointGrid, VisitsFewThatAreFar) {
  const std::vector<Vec3f> points = cloud();
  const PointGrid grid(points, 0.01f);
  int visited = 0;
  grid.visit({0, 0, 0}, 0.01f, [&](std::uint32_t) { ++visited; });
  EXPECT_LT(visited, 40);
}

TEST(PointGrid, LeavesOutWhatIsNotTaken) {
  const std::vector<Vec3f> points = cloud();
  std::vector<std::uint8_t> taken(points.size(), 0);
  taken[17] = taken[300] = 1;
  const PointGrid grid(points, 0.01f, taken);
  std::vector<std::uint32_t> visited;
  grid.visit({0, 0, 0}, 1, [&](std::uint32_t i) { visited.push_back(i); });
  EXPECT_EQ(visited.size(), 2u);
}

TEST(PointGrid, OfNothingVisitsNothing) {
  const PointGrid grid({}, 0.01f);
  EXPECT_TRUE(grid.empty());
  grid.visit({0, 0, 0}, 1, [](std::uint32_t) { FAIL(); });
}

}  // namespace
}  // namespace trocar::geometry
