// The GL backend on whatever OpenGL this machine has, without a display. A machine without EGL fails here: setup
// installs Mesa's software driver.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/render/backend/backend.hpp>
#include <trocar/render/frame/governor.hpp>
#include <trocar/render/gl/gl_context.hpp>
#include <trocar/render/gl/gl_program.hpp>

#include "gl_fixture.hpp"
#include "sample_scene.hpp"

namespace trocar::render {
namespace {

class GlBackend : public GlFixture {
 protected:
  MeshHandle ball(Vec3f centre, float radius, int rings = 48) {
    return sample::create(*backend, sample::sphere(centre, radius, rings));
  }
  MeshHandle white_ball(Vec3f centre, float radius) {
    sample::Shape shape = sample::sphere(centre, radius, 48);
    shape.paint.assign(shape.paint.size(), Paint{255, 255, 255, 255});
    return sample::create(*backend, shape);
  }
  Image draw(int width, int height) {
    draw_frame(*backend, frame, Target::off_screen(width, height));
    return backend->read_pixels();
  }
};

/// A surface that shows its irradiance and a faint gloss that falls off alike.
Material white() {
  Material m;
  m.shading = Shading::vertex_colour;
  return m;
}

/// The develop shader's curve, to get back from picture values to light (bisection; the curve rises).
double light_of(double picture) {
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double x = 0.5 * (low + high);
    const double y = 1.25 * x * (6.2 * x + 3.7) / (x * (6.2 * x + 5.4) + 0.78);
    (y < picture ? low : high) = x;
  }
  return 0.5 * (low + high);
}

double mean_luma(const Image& image) {
  double sum = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3)
    sum += 0.2126 * image.rgb[i] + 0.7152 * image.rgb[i + 1] + 0.0722 * image.rgb[i + 2];
  return sum / (255.0 * double(image.rgb.size() / 3));
}

TEST_F(GlBackend, EveryShaderVariantCompilesAndLinks) {
  GlPrograms programs;
  for (const char* detail : {"0", "1", "2"})
    for (const char* shading : {"0", "1", "2"})
      for (const char* extra : {"", ",FINE", ",VESSELS", ",LOBULES", ",VESSELS,ARCADE,RODS",
                                ",VESSELS,LINING,TWO_SIDED", ",VESSELS,LOBULES,STAINED,FOGGY,TWO_SIDED,RODS"})
        EXPECT_NO_THROW(programs.get("surface.vert", "surface.frag",
                                     std::string("SHADING=") + shading + ",DETAIL=" + detail + extra));
  for (const char* extra : {"", "LIT"}) EXPECT_NO_THROW(programs.get("flat.vert", "flat.frag", extra));
  for (const char* shape : {"full.vert", "disc.vert"}) {
    for (const char* extra :
         {"", "EFFECTS", "RODS", "EFFECTS,RODS", "SMOKE", "EFFECTS,RODS,SMOKE", "EFFECTS,RODS,SAMPLED"})
      EXPECT_NO_THROW(programs.get(shape, "develop.frag", extra));
    for (const char* extra : {"", "FRINGE", "FRINGE,SMOOTH", "SOILED", "SOILED,UNEVEN",
                              "FRINGE,SMOOTH,SOILED,UNEVEN,SMEARED,WIPED,DROPS", "SOILED,SMEARED,WIPED"})
      EXPECT_NO_THROW(programs.get(shape, "lens.frag", extra));
  }
  for (const char* detail : {"DETAIL=0", "DETAIL=1", "DETAIL=2"}) {
    EXPECT_NO_THROW(programs.get("sheet.vert", "sheet.frag", detail));
    EXPECT_NO_THROW(programs.get("tile.vert", "wet.frag", detail));
    EXPECT_NO_THROW(programs.get("full.vert", "smoke.frag", detail));
  }
  for (const char* extra : {"", "SAMPLED"}) EXPECT_NO_THROW(programs.get("shade.vert", "shade.frag", extra));
  EXPECT_NO_THROW(programs.get("splat.vert", "splat.frag"));
  EXPECT_NO_THROW(programs.get("tile.vert", "wet_mark.frag"));
  EXPECT_NO_THROW(programs.get("sheet.vert", "sheet_mark.frag"));
  EXPECT_NO_THROW(programs.get("full.vert", "shrink.frag", "SPREAD=1.0"));
  EXPECT_NO_THROW(programs.get("full.vert", "meter.frag"));
  EXPECT_NO_THROW(programs.get("mask.vert", "mask.frag"));
  EXPECT_NO_THROW(programs.get("puff.vert", "puff.frag"));
}

TEST_F(GlBackend, ABrokenShaderNamesItsFile) {
  try {
    GlProgram program("surface.vert", "surface.frag", "SHADING=),DETAIL=2");
    FAIL() << "nonsense was compiled";
  } catch (const core::EnvironmentLacks& e) {
    EXPECT_NE(std::string(e.what()).find("surface.frag"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("LIBGL_ALWAYS_SOFTWARE"), std::string::npos) << "it says what to do";
  }
}

GLenum says_reset() { return GL_INNOCENT_CONTEXT_RESET; }

TEST_F(GlBackend, ALostContextIsSaidInsteadOfDrawnInto) {
  EXPECT_FALSE(context->lost());
  auto* const current = epoxy_glGetGraphicsResetStatus;
  auto* const older = epoxy_glGetGraphicsResetStatusARB;
  epoxy_glGetGraphicsResetStatus = epoxy_glGetGraphicsResetStatusARB = says_reset;
  EXPECT_TRUE(context->lost());
  EXPECT_THROW(draw_frame(*backend, frame, Target::off_screen(32, 32)), core::EnvironmentLacks);
  epoxy_glGetGraphicsResetStatus = current;
  epoxy_glGetGraphicsResetStatusARB = older;
  EXPECT_NO_THROW(draw_frame(*backend, frame, Target::off_screen(32, 32)));
}

TEST_F(GlBackend, NoGlErrorInAFullFrame) {
  frame.camera = look_at({0.012f, -0.012f, 0.070f}, {0, 0.004f, -0.03f}, {0, 1, 0});
  sample::build(*backend, 2, frame);
  frame.puffs = {{{0, 0, 0}, 0.02f, 0.4f}, {{0.01f, 0, 0.01f}, 0.01f, 0.4f}};
  frame.look.fog = 2;
  while (glGetError() != GL_NO_ERROR) {
  }
  for (const Quality& quality : quality_levels()) {
    frame.quality = quality;
    frame.tick += 40;
    draw(160, 120);
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR)) << "scale " << quality.render_scale;
  }
}

TEST_F(GlBackend, NearIsBrighterThanFarByInverseSquare) {
  frame.look = plain_look();
  frame.light.bounce = 0;
  frame.light.position = {0, 0, 0};
  frame.light.intensity = 0.2f;
  frame.camera.vertical_fov = 0.3f;
  double light[2];
  const float distance[2] = {0.06f, 0.12f};
  for (int i = 0; i < 2; ++i) {
    frame.items.clear();
    // The lit point faces the eye: the ball's near pole lies at `distance`.
    frame.items.push_back({white_ball({0, 0, -(distance[i] + 0.02f)}, 0.02f), white(), {}, false});
    const Image image = draw(201, 201);
    light[i] = light_of(image.at(100, 100)[1] / 255.0);
    backend->destroy_mesh(frame.items[0].mesh);
  }
  EXPECT_NEAR(light[0] / light[1], 4.0, 0.25);
}

TEST_F(GlBackend, BlackOutsideTheMaskAndNotInside) {
  frame.items.push_back({ball({0, 0, 0}, 0.1f), {}, {}, false});
  frame.items[0].material.two_sided = true;  // the eye is inside: tissue everywhere
  const Image image = draw(320, 240);
  int lit = 0, inside = 0;
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x) {
      const double r = std::hypot(x + 0.5 - 160, y + 0.5 - 120);
      const std::uint8_t* p = image.at(x, y);
      if (r > 120.5) {
        ASSERT_EQ(p[0] + p[1] + p[2], 0) << x << "," << y;
      }
      if (r < 100) {
        ++inside;
        lit += p[0] > 10;
      }
    }
  EXPECT_EQ(lit, inside);
}

TEST_F(GlBackend, WithoutAMaskTheCornersShow) {
  frame.look = plain_look();
  frame.items.push_back({ball({0, 0, 0}, 0.1f), {}, {}, false});
  frame.items[0].material.two_sided = true;
  const Image image = draw(64, 48);
  for (int x : {0, 63})
    for (int y : {0, 47}) EXPECT_GT(image.at(x, y)[0], 10);
}

TEST_F(GlBackend, OneByOneTargetWorks) {
  frame.items.push_back({ball({0, 0, -0.05f}, 0.02f), {}, {}, false});
  const Image image = draw(1, 1);
  EXPECT_EQ(image.rgb.size(), 3u);
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

TEST_F(GlBackend, AutoExposureEvensOutTheLamp) {
  frame.items.push_back({ball({0, 0, 0}, 0.08f), {}, {}, false});
  frame.items[0].material.two_sided = true;
  double brightness[2];
  const float lamp[2] = {0.5f, 2.0f};
  for (int i = 0; i < 2; ++i) {
    frame.light.intensity = lamp[i];
    frame.eye = i;
    brightness[i] = mean_luma(draw(160, 160));
  }
  EXPECT_NEAR(brightness[0], brightness[1], 0.02);
  EXPECT_GT(brightness[0], 0.2);
  EXPECT_LT(brightness[0], 0.7);
}

TEST_F(GlBackend, AutoExposureFollowsWithALag) {
  frame.items.push_back({ball({0, 0, 0}, 0.08f), {}, {}, false});
  frame.items[0].material.two_sided = true;
  const double settled = mean_luma(draw(120, 120));
  frame.light.intensity = 1.5f;
  frame.tick += 40;
  const double soon = mean_luma(draw(120, 120));
  for (int i = 0; i < 60; ++i) {
    frame.tick += 40;
    draw(120, 120);
  }
  const double late = mean_luma(backend->read_pixels());
  EXPECT_GT(soon, settled + 0.1);
  EXPECT_NEAR(late, settled, 0.03);
}

TEST_F(GlBackend, TheSameFramesGiveTheSamePicture) {
  frame.camera = look_at({0.012f, -0.012f, 0.070f}, {0, 0.004f, -0.03f}, {0, 1, 0});
  sample::build(*backend, 0, frame);
  const Image first = draw(96, 72);
  auto other = make_gl_backend(*context);
  Frame again;
  again.camera = frame.camera;
  sample::build(*other, 0, again);
  draw_frame(*other, again, Target::off_screen(96, 72));
  EXPECT_EQ(first.rgb, other->read_pixels().rgb);
}

TEST_F(GlBackend, UpdateMeshMovesTheMesh) {
  frame.look = plain_look();
  sample::Shape shape = sample::sphere({0, 0, -0.06f}, 0.01f, 24);
  shape.paint.assign(shape.paint.size(), Paint{255, 255, 255, 255});
  frame.items.push_back({sample::create(*backend, shape), white(), {}, false});
  EXPECT_GT(draw(60, 60).at(30, 30)[1], 40);
  for (Vec3f& p : shape.positions) p.x += 0.03f;
  backend->update_mesh(frame.items[0].mesh, shape.positions, {}, {});
  const Image moved = draw(60, 60);
  EXPECT_LT(moved.at(30, 30)[1], 20);
  EXPECT_GT(moved.at(56, 30)[1], 20);
}

TEST_F(GlBackend, BloodReddensAndDarkensWhatItCovers) {
  frame.look = plain_look();
  sample::Shape shape = sample::sphere({0, 0, -0.06f}, 0.02f, 32);
  frame.items.push_back({sample::create(*backend, shape), {}, {}, false});
  frame.items[0].material.fresnel = 0;  // no highlights: only what is below them
  const auto share = [](const std::uint8_t* p) { return double(p[0]) / (p[0] + p[1] + p[2]); };
  const Image clean = draw(60, 60);
  for (Paint& p : shape.paint) p.blood = 255;
  backend->update_mesh(frame.items[0].mesh, shape.positions, {}, shape.paint);
  const Image bloody = draw(60, 60);
  EXPECT_GT(share(bloody.at(36, 30)), share(clean.at(36, 30)) + 0.2);
  EXPECT_LT(bloody.at(36, 30)[1], clean.at(36, 30)[1] / 3);
}

TEST_F(GlBackend, CrevicesAreAsDarkAsAskedFor) {
  frame.look = plain_look();
  sample::Shape shape = sample::sphere({0, 0, -0.06f}, 0.02f, 32);
  for (Paint& p : shape.paint) p.openness = 60;
  frame.items.push_back({sample::create(*backend, shape), {}, {}, false});
  double luma[3];
  for (const int half : {0, 1, 2}) {
    frame.light.crevices = 0.5f * float(half);
    luma[half] = mean_luma(draw(60, 60));
  }
  EXPECT_LT(luma[2], 0.9 * luma[1]);
  EXPECT_LT(luma[1], 0.95 * luma[0]);
}

TEST_F(GlBackend, OnlyWhatIsNearerThanTheFocusHasASoftOutline) {
  Material even = white();
  even.shading = Shading::unlit;
  frame.camera = look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0});
  sample::Shape wall = sample::sphere({0, 0, -0.6f}, 0.5f, 48);
  wall.paint.assign(wall.paint.size(), Paint{0, 0, 0, 255});
  const MeshHandle black_wall = sample::create(*backend, wall);
  const auto steepest = [&](float distance, float aperture) {
    frame.look = plain_look();
    frame.look.exposure_ev = -3;  // not clipped
    frame.look.aperture = aperture;
    frame.items = {{white_ball({0, 0, -distance}, 0.3f * distance), even, {}, false}, {black_wall, even, {}, false}};
    const Image image = draw(400, 400);
    int most = 0;
    for (int x = 200; x + 1 < 400; ++x)
      most = std::max(most, std::abs(int(image.at(x, 200)[0]) - int(image.at(x + 1, 200)[0])));
    return most;
  };
  const float pupil = EndoscopeLook{}.aperture, pinhole = 1e-6f;
  const int sharp = steepest(0.06f, pupil);
  EXPECT_EQ(steepest(0.15f, pupil), steepest(0.15f, pinhole)) << "what is far is in focus";
  EXPECT_GT(sharp, 0.95 * steepest(0.06f, pinhole)) << "so is where one works";
  EXPECT_GT(steepest(0.035f, pupil), 0.6 * sharp) << "and a close-up, nearly";
  EXPECT_GT(steepest(0.015f, pinhole), 0.95 * sharp);
  EXPECT_LT(steepest(0.025f, pupil), 0.8 * sharp);
  EXPECT_LT(steepest(0.015f, pupil), 0.45 * sharp);
}

/// A tilted wall with an upright bar before it, across the picture's middle row: how much darker than without the bar
/// the darkest pixel beside it is, of 1. @param gap, radius [m]
double darkest_beside_a_bar(Backend& backend, Frame& frame, float gap, float radius) {
  constexpr int kSize = 400;
  constexpr float kFar = 0.10f, kTilt = 0.8f;
  const auto made = [&backend](sample::Shape shape) {
    shape.paint.assign(shape.positions.size(), Paint{255, 255, 255, 255});
    return sample::create(backend, shape);
  };
  const MeshHandle wall = made(sample::sheet(2, 2, [](float u, float v) {
    const float y = 0.3f * (v - 0.5f);
    return Vec3f{0.3f * (u - 0.5f), y, kTilt * y - kFar};
  }));
  constexpr float kHalf = 0.03f, kRise = kTilt * kHalf;
  const Vec3f from{0, -kHalf, gap - kRise - kFar}, to{0, kHalf, gap + kRise - kFar};
  const MeshHandle bar = made(sample::tube({from, to}, {radius, radius}, 12));
  frame.look = plain_look();
  frame.look.contact = EndoscopeLook{}.contact;
  frame.look.exposure_ev = 0;
  const auto drawn = [&](bool with_bar) {
    frame.items = {{wall, white(), {}, false}};
    if (with_bar) frame.items.push_back({bar, white(), {}, false});
    draw_frame(backend, frame, Target::off_screen(kSize, kSize));
    return backend.read_pixels();
  };
  const Image bare = drawn(false), both = drawn(true);
  const float tall = 2 * (kFar - gap) * std::tan(0.5f * frame.camera.vertical_fov);  // of the picture, at the bar
  const int edge = int(std::ceil(radius / tall * kSize)) + 2;                        // its outline is smoothed
  double darkest = 0;
  for (int side : {-1, 1})
    for (int x = edge; x < edge + 40; ++x) {
      const int at = kSize / 2 + side * x;
      const double before = bare.at(at, kSize / 2)[1], after = both.at(at, kSize / 2)[1];
      darkest = std::max(darkest, (before - after) / before);
    }
  return darkest;
}

TEST_F(GlBackend, AThreadFarBeforeAWallLeavesNoDarkRim) {
  for (const float gap : {0.008f, 0.02f, 0.05f})
    for (const float radius : {0.00015f, 0.0003f, 0.0006f})
      EXPECT_LT(darkest_beside_a_bar(*backend, frame, gap, radius), 0.03) << gap << " m before it, " << radius;
}

TEST_F(GlBackend, AShaftCloseToAWallDarkensItBesideIt) {
  EXPECT_GT(darkest_beside_a_bar(*backend, frame, 0.006f, 0.005f), 0.06);
}

TEST_F(GlBackend, TranslucentItemsShowWhatIsBehind) {
  frame.look = plain_look();
  frame.items.push_back({white_ball({0, 0, -0.09f}, 0.02f), white(), {}, false});
  Material veil;
  veil.fresnel = 0;
  veil.alpha = veil.rim_alpha = 0.3f;
  frame.items.push_back({ball({0, 0, -0.06f}, 0.006f), veil, {}, true});
  const int both = draw(60, 60).at(30, 30)[2];
  frame.items.erase(frame.items.begin());
  const int alone = draw(60, 60).at(30, 30)[2];
  EXPECT_GT(both, alone + 30);
}

TEST_F(GlBackend, AFoldThatRunsOutOnAWallIsNoDarkCrease) {
  frame.look = plain_look();
  const auto plate = [&](float off, std::uint8_t openness) {
    sample::Shape shape = sample::sheet(2, 2, [off](float u, float v) {
      return Vec3f{0.08f * (u - 0.5f), 0.08f * (v - 0.5f), -off};
    });
    shape.paint.assign(shape.paint.size(), Paint{openness, 0, 0, 0});
    return sample::create(*backend, shape);
  };
  Material tissue;
  tissue.mottle = 0, tissue.wetness = 0, tissue.fresnel = 0;
  Material fold = tissue;
  fold.alpha = fold.rim_alpha = 0.9f;
  frame.items.push_back({plate(0.061f, 255), tissue, {}, false});
  const int wall = draw(60, 60).at(30, 30)[1];
  for (const int openness : {255, 120, 60, 20}) {
    frame.items.push_back({plate(0.06f, std::uint8_t(openness)), fold, {}, true});
    EXPECT_GT(draw(60, 60).at(30, 30)[1], 0.85 * wall) << "as open as " << openness;
    frame.items.pop_back();
  }
}

TEST_F(GlBackend, RestCoordinatesCarryThePattern) {
  frame.look = plain_look();
  Material spotted;
  spotted.mottle = 1;
  spotted.colour_b = {0, 0, 0};
  spotted.colour_c = {0, 0, 0};
  spotted.wetness = 0;
  spotted.bump = 0;
  const sample::Shape here = sample::sphere({0, 0, -0.06f}, 0.015f, 48);
  sample::Shape there = here;
  for (Vec3f& p : there.positions) p = p + Vec3f{0.3f, 0.2f, 0.1f};
  MeshData data;
  data.positions = there.positions;
  data.rest = here.positions;
  data.indices = here.triangles;
  frame.items.push_back({sample::create(*backend, here), spotted, {}, false});
  const Image a = draw(80, 80);
  frame.items[0].mesh = backend->create_mesh(data);
  frame.camera.position = {0.3f, 0.2f, 0.1f};
  const Image b = draw(80, 80);
  int worst = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) worst = std::max(worst, std::abs(a.rgb[i] - b.rgb[i]));
  EXPECT_LE(worst, 12);  // outlines may differ by a rounding
  double difference = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) difference += std::abs(a.rgb[i] - b.rgb[i]);
  EXPECT_LT(difference / double(a.rgb.size()), 0.2);
}

TEST_F(GlBackend, AFilmSparklesInClumpsTheWetterTheMore) {
  frame.look = plain_look();
  const sample::Shape bulge = sample::sphere({0, 0, -0.10f}, 0.05f, 96);
  Material tissue;
  tissue.mottle = 0;
  tissue.film_size = 0.0016f;
  tissue.film_bump = 0.24f;
  frame.items = {{sample::create(*backend, bulge), tissue, {}, false}};
  // Shares of pixels that are brighter than all around them, a grid of 8 x 8.
  const auto glints = [&](float wetness) {
    frame.items[0].material.wetness = wetness;
    const Image image = draw(320, 320);
    const auto red_free = [&](int x, int y) { return int(image.rgb[3 * (std::size_t(y) * 320 + std::size_t(x)) + 1]); };
    std::vector<double> share(64, 0.0);
    for (int y = 6; y < 314; ++y)
      for (int x = 6; x < 314; ++x) {
        const int around = red_free(x - 6, y) + red_free(x + 6, y) + red_free(x, y - 6) + red_free(x, y + 6);
        if (red_free(x, y) > around / 4 + 20) share[std::size_t(y / 40 * 8 + x / 40)] += 1.0 / (40 * 40);
      }
    return share;
  };
  const auto sum = [](const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); };
  const std::vector<double> dry = glints(0.3f), wet = glints(0.9f);
  EXPECT_GT(sum(wet), 1.5 * sum(dry));
  EXPECT_GT(*std::max_element(dry.begin(), dry.end()), 5 * sum(dry) / 64) << "spread evenly";
}

/// A flat floor of tissue 80 mm before the lens, without pattern or gloss, and a rod `above` it [m] across the picture.
/// @return its red, or another channel, along the middle column, 0..255, from the bottom up
std::vector<int> under_a_rod(Backend& backend, Frame frame, double above, bool with_rod, float pressed = 0,
                             int channel = 0) {
  const sample::Shape floor = sample::sheet(40, 40, [](float u, float v) {
    return Vec3f{0.12f * (u - 0.5f), 0.12f * (v - 0.5f), -0.08f};
  });
  DrawItem item;
  item.mesh = sample::create(backend, floor);
  item.material.mottle = item.material.bump = item.material.film_bump = item.material.wetness = 0;
  item.material.colour_b = item.material.colour_c = item.material.colour;
  frame.items = {item};
  frame.look = plain_look();
  frame.look.contact = 0;
  const float z = -0.08f + 0.0025f + float(above);
  if (with_rod) frame.rods = {Rod{{-0.04f, 0, z}, {0.04f, 0, z}, 0.0025f, pressed}};
  draw_frame(backend, frame, Target::off_screen(200, 400));
  const Image image = backend.read_pixels();
  std::vector<int> column;
  for (int y = image.height - 1; y >= 0; --y)
    column.push_back(image.rgb[3 * (std::size_t(y) * 200 + 100) + std::size_t(channel)]);
  return column;
}

TEST_F(GlBackend, ARodsShadowTellsItsHeight) {
  const std::vector<int> bare = under_a_rod(*backend, frame, 0, false);
  std::vector<double> low, steep;  // middle of the shadow below the picture's [px], steepest step between two rows
  for (const double above : {0.001, 0.01, 0.03}) {
    const std::vector<int> shaded = under_a_rod(*backend, frame, above, true);
    double weight = 0, sum = 0, most = 0, before = 0;
    for (std::size_t y = 0; y < bare.size(); ++y) {
      const double dark = bare[y] - shaded[y];
      EXPECT_GE(dark, -1.5) << "row " << y;  // a rod takes light only
      weight += dark;
      sum += dark * (200.0 - double(y));
      most = std::max(most, std::fabs(dark - before));
      before = dark;
    }
    ASSERT_GT(weight, 100) << above;
    low.push_back(sum / weight);
    steep.push_back(most);
  }
  // The lamp lies above the lens: the higher the rod, the farther below it lies its shadow, and the softer.
  EXPECT_GT(low[1], low[0] + 1);
  EXPECT_GT(low[2], low[1] + 3);
  EXPECT_GT(steep[0], 1.5 * steep[2]);
}

TEST_F(GlBackend, FarFromItARodShadesNothing) {
  const std::vector<int> bare = under_a_rod(*backend, frame, 0, false), shaded = under_a_rod(*backend, frame, 0, true);
  for (std::size_t y = 0; y < 60; ++y) EXPECT_NEAR(bare[y], shaded[y], 3) << y;
}

TEST_F(GlBackend, PressedTissuePalesAroundTheRodAndOnlyThere) {
  double redder[2], far[2];  // mean of red less green: 1 to 2 mm beside the rod, and far from it
  for (const float pressed : {0.0f, 1.0f}) {
    const std::vector<int> red = under_a_rod(*backend, frame, 0, true, pressed, 0);
    const std::vector<int> green = under_a_rod(*backend, frame, 0, true, pressed, 1);
    const auto mean = [&](std::size_t from, std::size_t to) {
      double sum = 0;
      for (std::size_t y = from; y < to; ++y) sum += red[y] - green[y];
      return sum / double(to - from);
    };
    redder[pressed > 0] = mean(210, 216);
    far[pressed > 0] = mean(20, 60);
  }
  EXPECT_LT(redder[1], 0.85 * redder[0]);
  EXPECT_NEAR(far[1], far[0], 0.5);
}

TEST_F(GlBackend, SmokePuffsTakeSaturation) {
  frame.look = plain_look();
  frame.items.push_back({ball({0, 0, -0.09f}, 0.03f), {}, {}, false});
  frame.items[0].material.fresnel = 0;
  const Image clear = draw(60, 60);
  for (int i = 0; i < 12; ++i) frame.puffs.push_back({{0, 0, -0.05f + 0.001f * float(i)}, 0.02f, 0.3f});
  const Image smoky = draw(60, 60);
  const auto saturation = [](const std::uint8_t* p) { return 1 - double(std::min(p[1], p[2])) / p[0]; };
  EXPECT_LT(saturation(smoky.at(36, 30)), saturation(clear.at(36, 30)) - 0.05);
}

TEST_F(GlBackend, PrepareChangesNoPicture) {
  frame.camera = look_at({0.012f, -0.012f, 0.070f}, {0, 0.004f, -0.03f}, {0, 1, 0});
  sample::build(*backend, 0, frame);
  const Image before = draw(64, 48);
  backend->prepare(frame.items);
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
  frame.eye = 1;  // a fresh memory of exposure
  const Image after = draw(64, 48);
  // Metal mirrors the picture before; the rest is the same to the bit.
  int different = 0;
  for (std::size_t i = 0; i < before.rgb.size(); ++i) different += std::abs(before.rgb[i] - after.rgb[i]) > 2;
  EXPECT_LT(different, 64 * 48 * 3 / 50);
}

TEST(GlContext, AdoptingWithoutAContextSaysSo) { EXPECT_THROW(GlContext::adopt_current(), core::EnvironmentLacks); }

TEST_F(GlBackend, AdoptsTheContextThatIsCurrent) {
  EXPECT_EQ(GlContext::adopt_current()->description(), context->description());
}

TEST_F(GlBackend, RefusesWhatTheNullBackendRefuses) {
  EXPECT_THROW(backend->end_frame(), Misuse);
  EXPECT_THROW(backend->destroy_mesh({17}), Misuse);
}

TEST_F(GlBackend, GhostsLetWhatIsBehindThemThroughAndEdgesLeaveFacesOpen) {
  frame.look = plain_look();
  frame.background = {0, 0, 0.6f};
  DrawItem item;
  item.mesh = ball({0, 0, -0.06f}, 0.015f, 12);
  const auto blue_in_the_middle = [&](DrawStyle style, Shading shading) {
    item.style = style;
    item.material.shading = shading;
    frame.items = {item};
    const Image image = draw(120, 120);
    int blue = 0;
    for (int y = 45; y < 75; ++y)
      for (int x = 45; x < 75; ++x) blue += image.at(x, y)[2] > image.at(x, y)[0] + 30;
    return blue;
  };
  for (const Shading shading : {Shading::tissue, Shading::metal}) {
    const int ghost = blue_in_the_middle(DrawStyle::transparent, shading);
    EXPECT_EQ(blue_in_the_middle(DrawStyle::shaded, shading), 0);
    EXPECT_GT(ghost, 600) << "of 900 pixels, shading " << int(shading);
    const int edges = blue_in_the_middle(DrawStyle::wireframe, shading);
    EXPECT_GT(edges, 300);
    EXPECT_LT(edges, 880) << "some edges";
  }
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

TEST_F(GlBackend, EveryPassIsTimedOnceAndTheirSumIsThePicture) {
  frame.items = {{ball({0, 0, -0.06f}, 0.02f), {}, {}, false}};
  draw(200, 150);
  std::vector<PassCost> costs;
  backend->profile(&costs);
  draw(200, 150);
  draw(200, 150);
  backend->profile(nullptr);
  const std::size_t passes = costs.size() / 2;
  ASSERT_GT(passes, 5u);
  double opaque = 0, all = 0;
  for (std::size_t i = 0; i < passes; ++i) {
    EXPECT_STREQ(costs[i].pass, costs[i + passes].pass);
    EXPECT_GE(costs[i].wall_ms, 0);
    EXPECT_GE(costs[i].processor_ms, 0);
    all += costs[i].processor_ms;
    if (std::string(costs[i].pass) == "opaque") opaque = costs[i].processor_ms;
    for (std::size_t j = 0; j < i; ++j) EXPECT_STRNE(costs[i].pass, costs[j].pass);
  }
  EXPECT_GT(opaque, 0);
  EXPECT_GT(all, opaque);
  draw(200, 150);
  EXPECT_EQ(costs.size(), 2 * passes) << "nobody asks any more";
}

TEST_F(GlBackend, APictureIsTheSameWhetherItIsTimedOrNot) {
  frame.items = {{ball({0, 0, -0.06f}, 0.02f), {}, {}, false}};
  frame.look.auto_exposure = false;
  const Image quiet = draw(200, 150);
  std::vector<PassCost> costs;
  backend->profile(&costs);
  EXPECT_EQ(draw(200, 150).rgb, quiet.rgb);
  backend->profile(nullptr);
}

TEST_F(GlBackend, SeveralSamplesAPixelTakeTheStepsOffAnOutline) {
  frame.look = plain_look();
  frame.camera = look_at({0, 0, 0.2f}, {0, 0, 0}, {0, 1, 0});
  Material even = white();
  even.shading = Shading::unlit;
  frame.look.exposure_ev = -3;  // not clipped
  frame.items = {{white_ball({0, 0, 0}, 0.05f), even, {}, false}};
  // How far rows lie apart where they cross the outline, against the circle that it is [px].
  const auto unevenness = [&](int samples) {
    frame.quality = {1, 0, 1, samples};  // without the lens pass's own smoothing
    const Image image = draw(200, 200);
    std::vector<double> width;
    for (int y = 60; y < 140; ++y) {
      double lit = 0;
      const auto light = [&](int x) {
        return light_of(image.rgb[3 * (std::size_t(y) * 200 + std::size_t(x))] / 255.0);
      };
      for (int x = 100; x < 200; ++x) lit += light(x) / light(100);
      width.push_back(lit);
    }
    double sum = 0;
    for (std::size_t i = 1; i + 1 < width.size(); ++i) sum += std::fabs(width[i - 1] - 2 * width[i] + width[i + 1]);
    return sum / double(width.size() - 2);
  };
  const double steps = unevenness(1), smooth = unevenness(4);
  EXPECT_LT(smooth, 0.6 * steps) << smooth << " of " << steps;
}

TEST_F(GlBackend, ACoarserLevelDrawsItsOwnTriangles) {
  const std::vector<Vec3f> corners{
      {-0.02f, -0.02f, -0.06f}, {0.02f, -0.02f, -0.06f}, {-0.02f, 0.02f, -0.06f}, {0.02f, 0.02f, -0.06f}};
  const std::vector<std::uint32_t> square{0, 1, 2, 2, 1, 3};
  const std::vector<std::vector<std::uint32_t>> half{{0, 1, 2}};
  MeshData data;
  data.positions = corners;
  data.indices = square;
  data.coarser = half;
  DrawItem item{backend->create_mesh(data), white(), {}, false};
  frame.look = plain_look();
  frame.items = {item};
  const double whole = mean_luma(draw(120, 90));
  frame.items[0].level = 1;
  const double coarse = mean_luma(draw(120, 90));
  EXPECT_GT(coarse, 0.3 * whole);
  EXPECT_LT(coarse, 0.7 * whole);
}

TEST_F(GlBackend, WhatIsOutOfSightIsLeftOutAndWhatReachesIntoThePictureIsNot) {
  frame.look = plain_look();
  const Image empty = draw(120, 90);
  for (const Vec3f centre : {Vec3f{0, 0, 0.06f}, Vec3f{0.2f, 0, -0.06f}, Vec3f{0, -0.2f, -0.06f}}) {
    frame.items = {{white_ball(centre, 0.02f), white(), {}, false}};
    EXPECT_EQ(draw(120, 90).rgb, empty.rgb);
  }
  // Its middle lies beside the picture, or behind the eye.
  for (const Vec3f centre : {Vec3f{0.055f, 0, -0.06f}, Vec3f{0.03f, 0, 0.001f}}) {
    const float radius = centre.z > 0 ? 0.028f : 0.02f;
    frame.items = {{white_ball(centre, radius), white(), {}, false}};
    EXPECT_NE(draw(120, 90).rgb, empty.rgb);
  }
}

}  // namespace
}  // namespace trocar::render
