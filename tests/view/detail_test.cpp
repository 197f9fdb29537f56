// How finely things are drawn, by how far off they are: when levels change, what they save, and that it is not seen.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/render/gl/gl_context.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/view/base/level_of_detail.hpp>
#include <trocar/view/bodies/organ_drawing.hpp>
#include <trocar/view/bodies/tube_drawing.hpp>
#include <trocar/view/scene/scene_view.hpp>

#include "pelvis.hpp"

namespace trocar::view {
namespace {

Detail two_levels() { return Detail({{0.05, 0.0001, 2}, {0.10, 0.0003, 1}}); }

TEST(Detail, LevelsRiseWithDistance) {
  Detail detail = two_levels();
  EXPECT_EQ(detail.level_at(0.03, 0), 0);
  EXPECT_EQ(detail.level_at(0.07, 0), 1);
  EXPECT_EQ(detail.level_at(0.20, 0), 2);
  EXPECT_EQ(detail.level_at(0.03, 0), 0);
}

TEST(Detail, NothingFlickersAtABorder) {
  Detail detail = two_levels();
  detail.level_at(0.07, 0);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(detail.level_at(0.05 * (1 + (i % 2 ? 0.05 : -0.05)), 0), 1);
  detail.level_at(0.03, 0);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(detail.level_at(0.05 * (1 + (i % 2 ? 0.05 : -0.05)), 0), 0);
}

TEST(Detail, EyesHaveLevelsOfTheirOwn) {
  Detail detail = two_levels();
  EXPECT_EQ(detail.level_at(0.20, 0), 2);
  EXPECT_EQ(detail.level_at(0.051, 1), 0);
  EXPECT_EQ(detail.level_at(0.101, 0), 2);
}

TEST(Detail, WithoutLevelsEverythingIsThere) {
  Detail detail;
  EXPECT_EQ(detail.level_at(5.0, 0), 0);
  EXPECT_EQ(detail.surface(0), 2);
}

/// A flat square of 20 x 20 places 1 mm apart.
struct Square {
  std::vector<Vec3f> positions;
  std::vector<std::uint32_t> indices;
  std::vector<Paint> paint = std::vector<Paint>(400);
  Square() {
    for (std::uint32_t i = 0; i < 400; ++i) positions.push_back({0.001f * float(i % 20), 0.001f * float(i / 20), 0});
    for (std::uint32_t j = 0; j < 19; ++j)
      for (std::uint32_t i = 0; i < 19; ++i) {
        const std::uint32_t a = 20 * j + i;
        indices.insert(indices.end(), {a, a + 1, a + 20, a + 1, a + 21, a + 20});
      }
  }
  std::vector<std::vector<std::uint32_t>> coarser(const Detail& detail, double longest = 0.01) const {
    return coarser_lists(positions, indices, paint, detail, longest);
  }
};

TEST(Detail, WhatWasCoarsenedBeforeIsNotTakenForAnother) {
  const Detail two = two_levels(), finer({{0.05, 0.00001, 2}});
  Square square;
  const auto first = square.coarser(two);
  ASSERT_EQ(first.size(), 2u);
  EXPECT_LT(first[0].size(), square.indices.size() / 2);
  EXPECT_EQ(square.coarser(two), first) << "again";
  EXPECT_EQ(square.coarser(finer).size(), 1u);
  EXPECT_GT(square.coarser(two, 0.002)[0].size(), first[0].size()) << "shorter edges";
  for (std::size_t i = 0; i < 400; i += 2) square.paint[i].tint = 255;
  EXPECT_GT(square.coarser(two)[0].size(), first[0].size()) << "painted";
  square.paint = Square().paint;
  for (std::size_t i = 0; i < 400; i += 2) square.positions[i].z = 0.003f;
  EXPECT_GT(square.coarser(two)[0].size(), first[0].size()) << "rough";
  EXPECT_EQ(Square().coarser(two), first);
}

TEST(DetailEye, AThingChangesAtTheSameSizeInPixels) {
  render::Camera camera;
  camera.vertical_fov = float(70 * std::numbers::pi / 180);
  const std::vector<Vec3f> at{{0, 0, -0.1f}};
  EXPECT_NEAR(DetailEye(camera, 600, {}, 0).distance(at), 0.1, 1e-4);
  EXPECT_NEAR(DetailEye(camera, 1200, {}, 0).distance(at), 0.05, 1e-4);
  EXPECT_NEAR(DetailEye(camera, 600, {0.5f, 2}, 0).distance(at), 0.2, 1e-4);
  EXPECT_NEAR(DetailEye(camera, 600, {1, 2, 2.5f}, 0).distance(at), 0.25, 1e-4);
  camera.vertical_fov = 2 * std::atan(0.5f * std::tan(camera.vertical_fov / 2));
  EXPECT_NEAR(DetailEye(camera, 600, {}, 0).distance(at), 0.05, 1e-4);
}

TEST(DetailEye, WhatIsBehindTheCameraCountsAsFarther) {
  const render::Camera camera;
  const DetailEye eye(camera, 600, {}, 0);
  const std::vector<Vec3f> before{{0, 0, -0.1f}}, behind{{0, 0, 0.1f}};
  EXPECT_NEAR(eye.distance(behind), 2 * eye.distance(before), 1e-6);
}

TEST(Detail, TheFileSaysItForThoseThatItNames) {
  sim::Model model;
  model.drawn_detail = {{"uterus", {{0.033, 0.0002, 1}}}};
  ASSERT_EQ(levels_of(model, "uterus").size(), 1u);
  EXPECT_EQ(levels_of(model, "uterus")[0].from, 0.033);
  EXPECT_GT(levels_of(model, "bladder").size(), 1u);
}

/// Radius of a ring of vertices that a coarse list uses, seen against the full one: the outline of a tube.
TEST(Detail, ATubesOutlineIsNoFartherInThanItsLevelSays) {
  const std::vector<sim::DetailLevel> levels{{0.06, 0.0001, 2}, {0.12, 0.00025, 2}};
  const int strand = pelvis().strand_index("round_ligament_left");
  ASSERT_GE(strand, 0);
  const TubeDrawing tube(pelvis(), strand, Detail(levels));
  const MeshBuffer& b = tube.drawn();
  ASSERT_EQ(b.coarser.size(), 2u);
  EXPECT_LT(b.coarser[0].size(), b.indices.size());
  EXPECT_LT(b.coarser[1].size(), b.coarser[0].size());
  for (std::size_t k = 0; k < 2; ++k) {  // a coarse edge's middle lies below the full surface by so much at most
    double deepest = 0;
    for (std::size_t i = 0; i + 2 < b.coarser[k].size(); i += 3) {
      const Vec3f a = b.positions[b.coarser[k][i]], c = b.positions[b.coarser[k][i + 1]];
      const Vec3f middle = 0.5f * (a + c);
      double nearest = 1;
      for (const Vec3f& p : b.positions) nearest = std::min(nearest, double(length(p - middle)));
      deepest = std::max(deepest, nearest);
    }
    EXPECT_LT(deepest, 0.004) << "no vertex of the full surface is near a coarse edge: it cuts through the air";
  }
}

/// Pictures of the pelvis on whatever OpenGL there is.
class DetailPictures : public testing::Test {
 protected:
  void SetUp() override {
    try {
      context = render::GlContext::off_screen();
    } catch (const core::EnvironmentLacks& e) {
      FAIL() << e.what();
    }
    backend = render::make_gl_backend(*context);
    view = std::make_unique<SceneView>(pelvis(), *backend);
  }
  void TearDown() override {
    view.reset();
    backend.reset();
    context.reset();
  }

  struct Drawn {
    render::Image image;
    std::uint64_t triangles = 0;
  };
  Drawn draw(float coarser, ViewOptions options = {}) {
    options.quality.coarser = coarser;
    options.eye_index = 1;
    render::Frame frame = view->frame(sim::initial_state(pelvis()), options);
    frame.look.auto_exposure = false;
    frame.look.noise = 0;
    const std::uint64_t before = backend->stats().triangles;
    render::draw_frame(*backend, frame, render::Target::off_screen(800, 600));
    return {backend->read_pixels(), backend->stats().triangles - before};
  }
  static double difference(const render::Image& a, const render::Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) sum += std::abs(int(a.rgb[i]) - int(b.rgb[i]));
    return sum / double(a.rgb.size());
  }

  std::unique_ptr<render::GlContext> context;
  std::unique_ptr<render::Backend> backend;
  std::unique_ptr<SceneView> view;
};

constexpr float kFull = 1e-6f;  // things are in full as far as the eye reaches

TEST_F(DetailPictures, DistanceSavesTrianglesAndIsNotSeen) {
  const Drawn full = draw(kFull), now = draw(1);
  EXPECT_LT(double(now.triangles), 0.85 * double(full.triangles));
  EXPECT_LT(difference(full.image, now.image), 0.5);
}

TEST_F(DetailPictures, TheGovernorsShiftSavesMoreAndIsHardlySeen) {
  const Drawn full = draw(kFull), now = draw(1), coarse = draw(2.5f);
  EXPECT_LT(double(coarse.triangles), 0.7 * double(now.triangles));
  EXPECT_LT(difference(full.image, coarse.image), 2.0);
}

TEST_F(DetailPictures, WhatAnInstrumentHoldsOrDentsIsInFull) {
  const auto level_of = [&](const std::string& name, const sim::State& state) {
    ViewOptions options;
    options.eye_index = 2;
    options.quality.coarser = 100;
    const render::Frame frame = view->frame(state, options);
    for (const render::DrawItem& i : frame.items)
      if (i.part > 0 && view->parts()[i.part - std::size_t(1)].name == name) return int(i.level);
    return -1;
  };
  sim::State state = sim::initial_state(pelvis());
  const BodyId tube = sim::body_of(pelvis(), "tube_left");
  EXPECT_GT(level_of("tube_left", state), 0);
  EXPECT_GT(level_of("uterus", state), 0);
  state.tools[0].holds = 1;
  state.tools[0].hold[0].at.body = tube;
  EXPECT_EQ(level_of("tube_left", state), 0);
  EXPECT_GT(level_of("uterus", state), 0);
  state.tools[0].hold[0].at.body = sim::body_of(pelvis(), "uterus");
  EXPECT_EQ(level_of("uterus", state), 0);
  EXPECT_GT(level_of("tube_left", state), 0);
  state.tools[0].holds = 0;
  const OrganDrawing uterus(
      pelvis().solids[std::size_t(pelvis().organ_index("uterus"))], Relief{},
      std::vector<Paint>(pelvis().solids[std::size_t(pelvis().organ_index("uterus"))].fine.rest.size()), *backend);
  const Vec3d port = pelvis().hands[0].port, top = vec_cast<double>(uterus.positions()[0]);
  const kinematics::FulcrumPose pose = kinematics::inverse(port, top, 0);
  state.tools[0].yaw = pose.yaw, state.tools[0].pitch = pose.pitch, state.tools[0].depth = pose.depth;
  EXPECT_EQ(level_of("uterus", state), 0);
}

TEST_F(DetailPictures, NearByEverythingIsInFull) {
  ViewOptions close;
  close.camera = ViewOptions::Camera::inside;
  close.eye = {0.034, -0.125, -0.068};
  close.target = {0.038, -0.152, -0.094};
  close.instruments = false;
  EXPECT_LT(difference(draw(kFull, close).image, draw(1, close).image), 0.3);
}

}  // namespace
}  // namespace trocar::view
