// Which side of a skin a point is on.
#include <array>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/interactions/contact/nearest_skin.hpp>

namespace trocar::interactions {
namespace {

/// A wedge that ends in a sharp corner at the origin, its broad face level and up [mm].
struct Wedge {
  tissue::Skin skin;
  tissue::SkinPose pose;

  Wedge() {
    constexpr std::array<std::array<float, 3>, 4> kCorners{{{0, 0, 0}, {-20, -10, 0}, {-20, 10, 0}, {-2, 0, -2}}};
    for (const auto& c : kCorners) skin.rest.push_back({1e-3f * c[0], 1e-3f * c[1], 1e-3f * c[2]});
    skin.rest_normal.resize(skin.rest.size());
    skin.weights.resize(skin.rest.size());
    skin.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    tissue::index_skin(skin);
    pose = tissue::make_pose(skin);
    pose.position = skin.rest;
    for (const Vec3f p : skin.rest) pose.bounds.add(p);
    for (int v = 0; v < skin.size(); ++v)
      skin.rest_normal[size_t(v)] = vec_cast<float>(tissue::skin_normal(skin, pose, v));
  }
  Surface surface() const { return {&skin, &pose, {}}; }
};

Vec3d millimetres(double x, double y, double z) { return 1e-3 * Vec3d{x, y, z}; }

TEST(NearestSkin, BesideASharpCornerItsNormalTellsTheWrongSideAndARayTheRightOne) {
  const Wedge wedge;
  const Vec3d beside = millimetres(1, 0, -0.3);
  const SkinPoint on = nearest_skin_point(wedge.surface(), 0, beside);
  ASSERT_LT(length(on.point), 1e-9) << "the corner";
  EXPECT_LT(dot(beside - on.point, on.normal), 0) << "its faces' mean looks away";
  EXPECT_FALSE(encloses(wedge.surface(), beside));
}

TEST(NearestSkin, ARayTellsInsideFromAboveBelowAndBeside) {
  const Wedge wedge;
  EXPECT_TRUE(encloses(wedge.surface(), millimetres(-5, 0, -0.2)));
  EXPECT_TRUE(encloses(wedge.surface(), millimetres(-3, 0.1, -1.5)));
  EXPECT_FALSE(encloses(wedge.surface(), millimetres(-5, 0, 0.2)));
  EXPECT_FALSE(encloses(wedge.surface(), millimetres(-5, 0, -3)));
  EXPECT_FALSE(encloses(wedge.surface(), millimetres(-5, 9, -0.2)));
  EXPECT_FALSE(encloses(wedge.surface(), millimetres(-25, 0, -0.2)));
}

}  // namespace
}  // namespace trocar::interactions
