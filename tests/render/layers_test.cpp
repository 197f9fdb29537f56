// What a picture shows where: depth, normals, parts and flow against closed forms.
#include <cmath>

#include <trocar/render/backend/layers.hpp>

#include "gl_fixture.hpp"

namespace trocar::render {
namespace {

constexpr int kWidth = 160, kHeight = 120;
constexpr std::uint16_t kPart = 7;

std::size_t at(int column, int row) { return std::size_t(row) * kWidth + std::size_t(column); }

class PictureLayers : public GlFixture {
 protected:
  void SetUp() override {
    GlFixture::SetUp();
    frame.camera.position = {0, 0, 0};  // looks along -z
    DrawItem item;
    item.mesh = backend->create_mesh({.positions = wall, .normals = {}, .rest = {}, .paint = {}, .indices = triangles});
    item.part = kPart;
    frame.items = {item};
  }
  Layers draw(const Camera& before) { return backend->draw_layers(frame, before, kWidth, kHeight); }
  Layers draw() { return draw(frame.camera); }

  /// A slanted wall: z = -0.1 - 0.5 x.
  std::vector<Vec3f> wall{{-0.1f, -0.2f, -0.05f}, {0.2f, -0.2f, -0.2f}, {0.2f, 0.2f, -0.2f}, {-0.1f, 0.2f, -0.05f}};
  const std::vector<std::uint32_t> triangles{0, 1, 2, 0, 2, 3};
};

TEST_F(PictureLayers, DepthOfASlantedWallIsWhatItsPlaneSaysThroughTheLensToo) {
  for (const float barrel : {0.0f, 0.1f}) {
    frame.look.barrel = barrel;
    const Layers layers = draw();
    const Projection lens(frame.camera, frame.look, kWidth, kHeight);
    int seen = 0;
    for (int row = 5; row < kHeight; row += 10)
      for (int column = 25; column < kWidth - 25; column += 10) {
        const float depth = layers.depth[at(column, row)];
        if (std::isnan(depth)) continue;
        const auto way = lens.straightened(float(column) - lens.centre_x, float(row) - lens.centre_y);
        const float tangent = way[0] / lens.focal;  // depth = 0.1 + 0.5 x, x = tangent depth
        EXPECT_NEAR(depth, 0.1f / (1 - 0.5f * tangent), 4e-4) << column << ' ' << row;
        EXPECT_EQ(layers.part[at(column, row)], kPart);
        ++seen;
      }
    EXPECT_GT(seen, 80);
  }
}

TEST_F(PictureLayers, NormalsAreUnitAndFaceTheCameraWithYDown) {
  const Layers layers = draw();
  const auto& n = layers.normal[at(kWidth / 2, kHeight / 2)];
  const float s = 1 / std::sqrt(1.25f);  // of the plane 0.5 x + z = -0.1 towards the eye, z away from the camera
  EXPECT_NEAR(n[0], 0.5f * s, 1e-4);
  EXPECT_NEAR(n[1], 0, 1e-4);
  EXPECT_NEAR(n[2], -s, 1e-4);
}

TEST_F(PictureLayers, NothingIsThereOutsideTheCircleOrBesideThings) {
  const Layers layers = draw();
  EXPECT_EQ(layers.part[at(2, 2)], 0);
  EXPECT_TRUE(std::isnan(layers.depth[at(2, 2)]));
  frame.items.clear();
  const Layers empty = draw();
  EXPECT_EQ(empty.part[at(kWidth / 2, kHeight / 2)], 0);
  EXPECT_TRUE(std::isnan(empty.normal[at(kWidth / 2, kHeight / 2)][0]));
}

TEST_F(PictureLayers, WhatRestsHasNoFlowAndWhatIsNewHasNone) {
  EXPECT_TRUE(std::isnan(draw().flow[at(80, 60)][0]));  // nothing was remembered
  backend->remember(frame);
  const Layers layers = draw();
  for (std::size_t i = 0; i < layers.flow.size(); ++i)
    if (layers.part[i]) {
      EXPECT_NEAR(layers.flow[i][0], 0, 2e-3);
      EXPECT_NEAR(layers.flow[i][1], 0, 2e-3);
    }
  backend->replace_mesh(frame.items[0].mesh,
                        {.positions = wall, .normals = {}, .rest = {}, .paint = {}, .indices = triangles});
  EXPECT_TRUE(std::isnan(draw().flow[at(80, 60)][0]));
}

TEST_F(PictureLayers, FlowOfACameraThatTurnsAndGoesLeadsToTheSamePointOfTheWall) {
  backend->remember(frame);
  const Camera before = frame.camera;
  frame.camera = look_at({0.01f, 0.004f, 0.008f}, {0.02f, -0.01f, -0.1f}, {0.1f, 1, 0});
  const Layers layers = draw(before);
  const Projection now(frame.camera, frame.look, kWidth, kHeight), then(before, frame.look, kWidth, kHeight);
  int seen = 0;
  for (int row = 5; row < kHeight; row += 10)
    for (int column = 25; column < kWidth - 25; column += 10) {
      const std::size_t i = at(column, row);
      if (!layers.part[i]) continue;
      const float depth = layers.depth[i];
      const auto way = now.straightened(float(column) - now.centre_x, float(row) - now.centre_y);
      const Vec3f eye{way[0] / now.focal * depth, -way[1] / now.focal * depth, -depth};
      const Vec3f world = frame.camera.rotation * eye + frame.camera.position;  // the first camera's frame, too
      const auto there = then.seen_at(world);
      EXPECT_NEAR(float(column) - now.centre_x + layers.flow[i][0], there[0], 0.75);  // half a texel each way
      EXPECT_NEAR(float(row) - now.centre_y + layers.flow[i][1], there[1], 0.75);
      ++seen;
    }
  EXPECT_GT(seen, 80);
}

TEST_F(PictureLayers, FlowOfAThingThatMovesIsItsProjectedWayBack) {
  backend->remember(frame);
  for (Vec3f& p : wall) p.y += 0.004f;
  backend->update_mesh(frame.items[0].mesh, wall, {}, {});
  frame.look.barrel = 0;
  const Layers layers = draw();
  const std::size_t i = at(kWidth / 2, kHeight / 2);
  const Projection lens(frame.camera, frame.look, kWidth, kHeight);
  EXPECT_NEAR(layers.flow[i][0], 0, 1e-2);
  EXPECT_NEAR(layers.flow[i][1], lens.focal * 0.004f / layers.depth[i], 1e-2);  // it was lower
}

TEST_F(PictureLayers, AnItemThatIsMovedAsAWholeFlowsWithItsPlacement) {
  backend->remember(frame);
  frame.items[0].transform = placement(Mat3f::identity(), {0.003f, 0, 0});
  frame.look.barrel = 0;
  const Layers layers = draw();
  const std::size_t i = at(kWidth / 2, kHeight / 2);
  const Projection lens(frame.camera, frame.look, kWidth, kHeight);
  const float depth = layers.depth[i];
  EXPECT_NEAR(layers.flow[i][0], -lens.focal * 0.003f / depth, 1e-2);
}

TEST_F(PictureLayers, AGatheredLiquidAndADropAreTheLiquidsPart) {
  frame.liquid.part = 9;
  for (int k = 0; k < 3; ++k) {
    SheetVertex v;
    v.position = {k == 1 ? 0.05f : 0.001f, k == 2 ? 0.05f : 0.001f, -0.05f};
    v.normal = {0, 0, 1};
    v.cover = 1;
    frame.liquid.sheet.push_back(v);
  }
  frame.liquid.triangles = {0, 1, 2};
  Splat drop;
  drop.from = drop.to = {-0.01f, -0.01f, -0.05f};
  drop.radius = 0.002f;
  frame.liquid.splats = {drop};
  const Layers layers = draw();
  const Projection lens(frame.camera, frame.look, kWidth, kHeight);
  for (const Vec3f p : {Vec3f{0.01f, 0.01f, -0.05f}, Vec3f{-0.01f, -0.01f, -0.05f}}) {
    const auto place = lens.seen_at(p);
    const std::size_t i = at(int(lens.centre_x + place[0] + 0.5f), int(lens.centre_y + place[1] + 0.5f));
    EXPECT_EQ(layers.part[i], 9) << p.x;
    EXPECT_NEAR(layers.depth[i], 0.05f, 3e-4);  // a drop is a disc that faces the eye
    EXPECT_TRUE(std::isnan(layers.flow[i][0]));
  }
}

TEST_F(PictureLayers, GhostsAndEdgesAreNotThere) {
  for (const DrawStyle style : {DrawStyle::transparent, DrawStyle::wireframe}) {
    frame.items[0].style = style;
    EXPECT_EQ(draw().part[at(80, 60)], 0);
  }
}

TEST(Projections, BendingUndoesStraightening) {
  Camera camera;
  EndoscopeLook look;
  for (const float barrel : {0.0f, 0.1f, 0.23f}) {
    look.barrel = barrel;
    const Projection lens(camera, look, 800, 600);
    for (const float x : {-290.0f, -3.0f, 0.0f, 120.0f, 399.0f}) {
      const auto s = lens.straightened(x, 0.4f * x);
      const auto b = lens.bent(s[0], s[1]);
      EXPECT_NEAR(b[0], x, 1e-2);
      EXPECT_NEAR(b[1], 0.4f * x, 1e-2);
    }
  }
}

TEST(Projections, WhatLiesBehindTheLensIsNowhere) {
  const Projection lens(Camera{}, EndoscopeLook{}, 800, 600);
  EXPECT_TRUE(std::isnan(lens.seen_at({0, 0, 0.01f})[0]));
}

TEST(NullLayers, SayThatNothingIsSeenAndRefuseAMeshThatIsNotThere) {
  const std::unique_ptr<Backend> backend = make_null_backend();
  Frame frame;
  const Layers layers = backend->draw_layers(frame, frame.camera, 8, 6);
  EXPECT_EQ(layers.part, std::vector<std::uint16_t>(48, 0));
  frame.items.push_back({.mesh = {3}, .material = {}, .transform = {}});
  EXPECT_THROW(static_cast<void>(backend->draw_layers(frame, frame.camera, 8, 6)), Misuse);
  EXPECT_THROW(backend->remember(frame), Misuse);
}

}  // namespace
}  // namespace trocar::render
