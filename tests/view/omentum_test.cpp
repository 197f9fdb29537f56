#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include <trocar/view/anatomy/omentum.hpp>

namespace trocar::view {
namespace {

constexpr Vec3d kGravity{0, 0, -9.81};

/// A bowl z = (x^2 + y^2) / 0.2, 32 cm wide, in steps of 5 mm, open above.
tissue::Skin bowl() {
  constexpr int n = 65;
  tissue::Skin skin;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const float x = 0.005f * float(i - n / 2), y = 0.005f * float(j - n / 2);
      skin.rest.push_back({x, y, (x * x + y * y) / 0.2f});
      skin.rest_normal.push_back(normalised(Vec3f{-10 * x, -10 * y, 1}));
      const int a = j * n + i;
      if (i + 1 < n && j + 1 < n) {
        skin.triangles.push_back({a, a + 1, a + n + 1});
        skin.triangles.push_back({a, a + n + 1, a + n});
      }
    }
  return skin;
}

double over_bowl(Vec3f p) { return double(p.z) - double(p.x * p.x + p.y * p.y) / 0.2; }

TEST(Omentum, LiesOnTheLowestPartOfAWallOnly) {
  const MeshBuffer fat = omentum_on(bowl(), kGravity);
  ASSERT_GT(fat.size(), 1000u);
  double thickest = 0;
  for (const Vec3f& p : fat.positions) {
    EXPECT_LT(p.z, 0.6f * 0.256f);  // of the bowl's height
    thickest = std::max(thickest, over_bowl(p));
  }
  EXPECT_GT(thickest, 0.004);
  EXPECT_LT(thickest, 0.022);  // upright, on a slope
}

TEST(Omentum, RunsOutUnderTheWallSoThatNoEdgeShows) {
  const MeshBuffer fat = omentum_on(bowl(), kGravity);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t t = 0; t < fat.indices.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k) ++edges[std::minmax(fat.indices[t + k], fat.indices[t + (k + 1) % 3])];
  int border = 0;
  for (const auto& [edge, triangles] : edges) {
    EXPECT_LE(triangles, 2);
    const Vec3f& p = fat.positions[edge.first];
    if (triangles == 2 || std::max(std::fabs(p.x), std::fabs(p.y)) > 0.14f) continue;  // there the bowl itself ends
    ++border;
    EXPECT_LT(over_bowl(p), 1e-4);
  }
  EXPECT_GT(border, 50);
}

TEST(Omentum, ALevelWallHasNoLowestPart) {
  tissue::Skin level = bowl();
  for (Vec3f& p : level.rest) p.z = 0;
  EXPECT_EQ(omentum_on(level, kGravity).size(), 0u);
}

}  // namespace
}  // namespace trocar::view
