// Liquids, smoke and a soiled lens: what the checks refuse, and what the picture shows, by numbers where there is a
// law.
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/render/backend/backend.hpp>
#include <trocar/render/frame/governor.hpp>
#include <trocar/render/gl/gl_context.hpp>

#include "gl_fixture.hpp"
#include "sample_scene.hpp"

namespace trocar::render {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

Splat drop(Vec3f at, float radius) {
  Splat s;
  s.from = s.to = at;
  s.radius = s.height = radius;
  return s;
}

LiquidLook blood() {
  LiquidLook look;
  look.kinds[0].absorbs = {0.8e3f, 28e3f, 24e3f};
  look.kinds[0].deep = {0.22f, 0.008f, 0.010f};
  look.kinds[0].cells = 20;
  return look;
}

/// A level sheet of 40 mm across the view, 60 mm off.
void add_sheet(Liquid& liquid, float depth, float share_b) {
  for (int k = 0; k < 4; ++k) {
    SheetVertex v;
    v.position = {k % 2 ? 0.02f : -0.02f, k / 2 ? 0.02f : -0.02f, -0.06f};
    v.normal = {0, 0, 1};
    v.depth = depth;
    v.cover = 1;
    v.share_b = share_b;
    liquid.sheet.push_back(v);
  }
  liquid.triangles = {0, 1, 3, 0, 3, 2};
}

void add_smoke(SmokeVolume& smoke, float density, float near_face, float far_face) {
  smoke.nx = smoke.ny = smoke.nz = 8;
  smoke.cell = (far_face - near_face) / 8;
  smoke.origin = {-4 * smoke.cell, -4 * smoke.cell, -far_face};
  smoke.density.assign(512, density);
}

class LiquidChecks : public testing::Test {
 protected:
  void SetUp() override { backend = make_null_backend(); }
  std::string refusal() {
    try {
      draw_frame(*backend, frame, Target::off_screen(32, 24));
    } catch (const Misuse& misuse) {
      return misuse.what();
    }
    return "";
  }
  std::unique_ptr<Backend> backend;
  Frame frame;
};

TEST_F(LiquidChecks, TakeWhatIsSoundAndCountIt) {
  frame.liquid.splats = {drop({0, 0, -0.05f}, 0.001f), drop({0, 0, -0.06f}, 0.001f)};
  add_sheet(frame.liquid, 0.001f, 0.5f);
  add_smoke(frame.smoke, 1, 0.02f, 0.04f);
  frame.look.soil.fog = 1;
  frame.look.soil.drop_count = LensSoil::kMaxDrops;
  EXPECT_EQ(refusal(), "");
  EXPECT_EQ(backend->stats().splats, 2u);
  EXPECT_EQ(backend->stats().sheet_triangles, 2u);
}

TEST_F(LiquidChecks, RefuseASplatThatCannotBe) {
  frame.liquid.splats = {drop({0, 0, -0.05f}, 0.001f), drop({0, kNaN, 0}, 0.001f)};
  EXPECT_EQ(refusal(), "begin_frame: splat 1 is not finite");
  frame.liquid.splats = {drop({0, 0, 0}, 0)};
  EXPECT_EQ(refusal(), "begin_frame: splat 0 has no radius");
  frame.liquid.splats = {drop({0, 0, 0}, 0.001f)};
  frame.liquid.splats[0].share = {0.8f, 0.8f, 0};
  EXPECT_EQ(refusal(), "begin_frame: splat 0 holds more than all");
  frame.liquid.splats[0].share = {1, 0, 0};
  frame.liquid.splats[0].kind = SplatKind::lying;
  EXPECT_EQ(refusal(), "begin_frame: splat 0 lies on a surface without a unit normal");
}

TEST_F(LiquidChecks, RefuseASheetThatIsNoMesh) {
  add_sheet(frame.liquid, 0.001f, 0);
  frame.liquid.triangles.back() = 4;
  EXPECT_EQ(refusal(), "begin_frame: the sheet's index 4 with only 4 vertices");
  frame.liquid.triangles.pop_back();
  EXPECT_EQ(refusal(), "begin_frame: the sheet's indices are not a whole number of triangles");
  frame.liquid.triangles.clear();
  frame.liquid.sheet[2].cover = kNaN;
  EXPECT_EQ(refusal(), "begin_frame: sheet vertex 2 is not finite");
}

TEST_F(LiquidChecks, RefuseSmokeThatDoesNotFitItsGrid) {
  add_smoke(frame.smoke, 1, 0.02f, 0.04f);
  frame.smoke.density.pop_back();
  EXPECT_EQ(refusal(), "begin_frame: smoke has 511 densities for its grid");
  frame.smoke.density.push_back(-1);
  EXPECT_EQ(refusal(), "begin_frame: smoke has a density that cannot be");
}

TEST_F(LiquidChecks, RefuseALensThatCannotBe) {
  frame.look.soil.fog = 1.5f;
  EXPECT_EQ(refusal(), "begin_frame: what is on the lens is not within 0..1");
  frame.look.soil.fog = 0;
  frame.look.soil.drop_count = LensSoil::kMaxDrops + 1;
  EXPECT_EQ(refusal(), "begin_frame: too many drops on the lens");
}

class Liquids : public GlFixture {
 protected:
  void SetUp() override {
    GlFixture::SetUp();
    frame.look = plain_look();
    frame.look.exposure_ev = -0.5f;  // the lightest plate is not clipped
    frame.liquid.look = blood();
  }
  /// A plate that faces the eye, `off` metres away, of one sRGB grey.
  void add_plate(float off, std::uint8_t grey, float from_x = -1, float to_x = 1) {
    sample::Shape shape = sample::sheet(2, 2, [&](float u, float v) {
      return Vec3f{from_x + (to_x - from_x) * u, 2 * v - 1, -off};
    });
    shape.paint.assign(shape.paint.size(), Paint{grey, grey, grey, 255});
    Material paint;
    paint.shading = Shading::unlit;
    paint.two_sided = true;
    frame.items.push_back({sample::create(*backend, shape), paint, {}, false});
  }
  Image draw(int width = 120, int height = 120) {
    draw_frame(*backend, frame, Target::off_screen(width, height));
    return backend->read_pixels();
  }
  /// Scene light of a picture value: the develop shader's curve, backwards.
  static double light_of(double picture) {
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
      const double x = 0.5 * (low + high);
      const double y = 1.25 * x * (6.2 * x + 3.7) / (x * (6.2 * x + 5.4) + 0.78);
      (y < picture ? low : high) = x;
    }
    return 0.5 * (low + high);
  }
  static double light_at(const Image& image, int x, int y, int channel) {
    return light_of(image.at(x, y)[channel] / 255.0);
  }
};

TEST_F(Liquids, NoGlErrorAtAnyQualityNorWhenMadeReady) {
  while (glGetError() != GL_NO_ERROR) {
  }
  backend->prepare_liquids();
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
  add_plate(0.08f, 160);
  frame.look = {};
  frame.liquid.splats = {drop({0, 0, -0.05f}, 0.001f), drop({0, 0, 0.05f}, 0.001f)};  // one behind the eye
  frame.liquid.splats.push_back(drop({0.004f, 0, -0.08f}, 0.001f));
  frame.liquid.splats[2].kind = SplatKind::film;
  frame.liquid.splats[2].normal = {0, 0, 1};
  add_sheet(frame.liquid, 0.002f, 0.3f);
  add_smoke(frame.smoke, 5, 0.01f, 0.07f);
  frame.look.soil.fog = 0.5f;
  frame.look.soil.smear = 0.3f;
  frame.look.soil.wipe = 0.4f;
  frame.look.soil.drop_count = 2;
  for (const Quality& quality : quality_levels()) {
    frame.quality = quality;
    frame.tick += 40;
    draw(160, 120);
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR)) << "scale " << quality.render_scale << " detail " << quality.detail;
  }
  draw(1, 1);
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

TEST_F(Liquids, LeaveNothingBehindInTheNextPicture) {
  add_plate(0.08f, 160);
  const Image before = draw();
  Frame clean = frame;
  frame.liquid.splats = {drop({0, 0, -0.05f}, 0.003f)};
  add_sheet(frame.liquid, 0.002f, 0);
  add_smoke(frame.smoke, 5, 0.01f, 0.07f);
  frame.look.soil.fog = 0.8f;
  EXPECT_NE(draw().rgb, before.rgb);
  frame = clean;
  EXPECT_EQ(draw().rgb, before.rgb);
}

TEST_F(Liquids, DropsThatTouchHaveOneOutline) {
  add_plate(0.06f, 200);
  frame.camera.vertical_fov = 0.2f;
  const float r = 0.0006f, gap = 1.1f * r;
  const auto redness = [](const std::uint8_t* p) { return int(p[0]) - int(p[1]); };
  frame.liquid.splats = {drop({-gap, 0, -0.05f}, r)};
  const Image one = draw();
  frame.liquid.splats.push_back(drop({gap, 0, -0.05f}, r));
  const Image two = draw();
  EXPECT_GT(redness(one.at(60 - 7, 60)), 60);
  EXPECT_LT(redness(one.at(60, 60)), 40);  // a lone drop does not reach the middle, but its colour spreads a pixel
  EXPECT_GT(redness(two.at(60, 60)), 60);  // two of them do
  EXPECT_LT(redness(two.at(60, 60 + 9)), 30);
}

TEST_F(Liquids, ADropBehindTissueIsHidden) {
  add_plate(0.05f, 200);
  const Image bare = draw();
  frame.liquid.splats = {drop({0, 0, -0.06f}, 0.002f)};
  EXPECT_EQ(draw().rgb, bare.rgb);
}

TEST_F(Liquids, AFilmOnAPlateBesideItsOwnIsNotDrawn) {
  add_plate(0.05f, 200);
  const Image bare = draw();
  Splat film = drop({0, 0, -0.058f}, 0.002f);  // 8 mm behind: it lies on something else
  film.kind = SplatKind::film, film.normal = {0, 0, 1}, film.height = 50e-6f;
  frame.liquid.splats = {film};
  EXPECT_EQ(draw().rgb, bare.rgb);
  frame.liquid.splats[0].from.z = frame.liquid.splats[0].to.z = -0.05f;
  EXPECT_NE(draw().rgb, bare.rgb);
}

/// The last item becomes a veil that lets a share of what is behind it through.
void make_veil(Frame& frame, float through) {
  frame.items.back().translucent = true;
  frame.items.back().material.alpha = 1 - through;
}

TEST_F(Liquids, AVeilBehindAnOutlineIsWholeBesideAPool) {
  frame.quality = {1, 0, 1, 4};
  sample::Shape ball = sample::sphere({0, 0, -0.05f}, 0.008f, 48);
  ball.paint.assign(ball.paint.size(), Paint{220, 220, 220, 255});
  Material paint;
  paint.shading = Shading::unlit;
  frame.items.push_back({sample::create(*backend, ball), paint, {}, false});
  add_plate(0.07f, 220);
  make_veil(frame, 0.1f);
  const auto darkest = [&] {
    const Image image = draw();
    int least = 255;
    for (int y = 30; y < 90; ++y)
      for (int x = 30; x < 90; ++x) least = std::min(least, int(image.at(x, y)[0]));
    return least;
  };
  const int alone = darkest();
  add_sheet(frame.liquid, 0.002f, 0);
  for (SheetVertex& v : frame.liquid.sheet) v.position.x += 0.06f;  // beside the ball
  ASSERT_GT(alone, 100);
  EXPECT_NEAR(darkest(), alone, 2);
}

TEST_F(Liquids, AVeilBeforeAPoolIsLaidOverItOnce) {
  constexpr float kThrough = 0.6f;
  frame.quality.detail = 1;  // no mirror image of the picture before
  add_plate(0.065f, 20);
  const auto light = [&] { return light_at(draw(), 60, 60, 0); };
  add_plate(0.05f, 120);
  make_veil(frame, kThrough);
  const double over_dark = light();
  frame.items.pop_back();
  const double dark = light();
  add_sheet(frame.liquid, 0.004f, 0);
  const double pool = light();
  add_plate(0.05f, 120);
  make_veil(frame, kThrough);
  ASSERT_GT(pool, 1.5 * dark);
  const double expected = over_dark + double(kThrough) * (pool - dark);
  EXPECT_NEAR(light(), expected, 0.05 * expected);
}

TEST_F(Liquids, ASheetTakesLightByTheLawOfBeerAndLambert) {
  add_plate(0.065f, 230);
  frame.liquid.look.fresnel = 0;
  frame.liquid.look.kinds[0].deep = {0, 0, 0};
  frame.light.intensity = 0;  // no mirror images of walls: the plate shines by itself
  // Down and, at right angles to the surface, up: 2 depths. One part in 200 is blood.
  const float mu[3] = {0.8e3f, 28e3f, 24e3f}, share = 0.005f;
  double light[2][3];
  const float depth[2] = {0.001f, 0.003f};
  for (int i = 0; i < 2; ++i) {
    frame.liquid.sheet.clear();
    add_sheet(frame.liquid, depth[i], 1 - share);
    const Image image = draw();
    for (int c = 0; c < 3; ++c) light[i][c] = light_at(image, 60, 60, c);
  }
  for (int c = 0; c < 3; ++c) {
    const double expected = std::exp(-2.0 * double(mu[c]) * double(share) * double(depth[1] - depth[0]));
    EXPECT_NEAR(light[1][c] / light[0][c], expected, 0.05 * expected + 0.01) << "channel " << c;
  }
}

TEST_F(Liquids, OrangeGoesFirstSoThinBloodTakesRedAndDeepBloodLetsTheRestThrough) {
  add_plate(0.065f, 180);
  frame.liquid.look.fresnel = 0;
  frame.liquid.look.kinds[0].deep = {0, 0, 0};
  frame.liquid.look.kinds[0].orange = 7e3f;
  frame.liquid.look.orange_share = 0.3f;
  frame.light.intensity = 0;
  const double depths[3] = {0.001, 0.004, 0.02}, share = 0.01;
  double red[3];
  for (int i = 0; i < 3; ++i) {
    frame.liquid.sheet.clear();
    add_sheet(frame.liquid, float(depths[i]), 1 - float(share));
    red[i] = light_at(draw(), 60, 60, 0);
  }
  const auto law = [&](double depth) {
    const double path = 2 * depth * share;
    return std::exp(-0.8e3 * path) * (0.7 + 0.3 * std::exp(-7e3 * path));
  };
  for (int i = 1; i < 3; ++i) EXPECT_NEAR(red[i] / red[0], law(depths[i]) / law(depths[0]), 0.03) << i;
}

TEST_F(Liquids, ASheetEndsWhereItsCoverFallsBelowAThird) {
  add_plate(0.065f, 200);
  const Image bare = draw();
  add_sheet(frame.liquid, 0.004f, 0);
  for (int k = 0; k < 4; ++k) frame.liquid.sheet[std::size_t(k)].cover = k % 2 ? 1.0f : 0.0f;
  const Image image = draw();
  // 40 mm at 60 mm off, in a view of 2 x 0.58 x 60 mm: 69 px; a third of the way along it lies at pixel 48.
  int first = 120;
  for (int x = 0; x < 120; ++x)
    if (std::abs(int(image.at(x, 60)[1]) - int(bare.at(x, 60)[1])) > 12) first = std::min(first, x);
  EXPECT_NEAR(first, 60 - 35 + 23, 3);
}

TEST_F(Liquids, SmokeTakesContrastByItsLaw) {
  add_plate(0.10f, 230, -1, 0);
  add_plate(0.10f, 60, 0, 1);
  frame.quality.detail = 0;  // without curls the grid is even
  frame.light.intensity = 0.02f;
  const auto contrast = [&] {
    const Image image = draw();
    return light_at(image, 30, 60, 1) - light_at(image, 90, 60, 1);
  };
  const double clear = contrast();
  add_smoke(frame.smoke, 8, 0.01f, 0.09f);
  frame.smoke.kappa = 0.7f;
  // The ray to pixel 30 is longer than the one down the middle by a few per cent.
  const double aside = std::sqrt(1 + 0.25 * std::pow(std::tan(0.5 * double(frame.camera.vertical_fov)), 2));
  EXPECT_NEAR(contrast() / clear, std::exp(-0.7 * 8 * 0.08 * aside), 0.04);
  frame.smoke.kappa = 10;
  EXPECT_NEAR(contrast() / clear, 0.63, 0.05) << "more than half is left however thick it is";
}

TEST_F(Liquids, WhatIsBeforeTheSmokeStaysClear) {
  add_plate(0.03f, 200);
  const Image clear = draw();
  add_smoke(frame.smoke, 50, 0.04f, 0.12f);
  const Image behind = draw();
  for (std::size_t i = 0; i < clear.rgb.size(); ++i) ASSERT_NEAR(clear.rgb[i], behind.rgb[i], 1);
}

TEST_F(Liquids, FogBlursAndLiftsBlacks) {
  add_plate(0.06f, 220, -1, 0);
  add_plate(0.06f, 5, 0, 1);
  const Image clear = draw(240, 240);
  frame.look.soil.fog = 0.6f;
  const Image fogged = draw(240, 240);
  const auto steepest = [](const Image& image) {
    int most = 0;
    for (int x = 100; x < 140; ++x) most = std::max(most, std::abs(image.at(x + 1, 120)[0] - image.at(x, 120)[0]));
    return most;
  };
  EXPECT_GT(steepest(clear), 2.5 * steepest(fogged));  // some light comes straight through
  EXPECT_GT(fogged.at(200, 120)[0], clear.at(200, 120)[0] + 15);
  EXPECT_LT(fogged.at(40, 120)[0], clear.at(40, 120)[0]);
}

TEST_F(Liquids, AWipeClearsFogWhereItHasPassed) {
  add_plate(0.06f, 220, -1, 0);
  add_plate(0.06f, 5, 0, 1);
  const Image clear = draw(240, 240);
  frame.look.soil.fog = 1;
  frame.look.soil.smear_angle = std::numbers::pi_v<float>;  // from the right to the left
  const Image fogged = draw(240, 240);
  frame.look.soil.wipe = 0.55f;  // the swab is in the middle: the right side is wiped, the left still fogged
  const Image wiped = draw(240, 240);
  const auto off = [&](const Image& image, int x) {
    return std::abs(int(image.at(x, 120)[0]) - int(clear.at(x, 120)[0]));
  };
  EXPECT_LT(off(wiped, 225), off(fogged, 225) / 2);
  EXPECT_NEAR(off(wiped, 12), off(fogged, 12), 3);
}

}  // namespace
}  // namespace trocar::render
