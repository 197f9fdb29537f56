// What a frame lists of fluids, smoke and the lens, from States that the fluids' own step has made.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include <trocar/render/backend/backend.hpp>
#include <trocar/view/fluids/blood_run.hpp>
#include <trocar/view/fluids/fluid_drawing.hpp>
#include <trocar/view/fluids/lens.hpp>
#include <trocar/view/fluids/smoke_drawing.hpp>

namespace trocar::view {
namespace {

using fluids::kMicrolitre;
using fluids::kMillilitre;

fluids::FluidsDescription small() {
  fluids::FluidsDescription d;
  d.pool.nx = d.pool.ny = 32;
  d.pool.origin = {-0.02, -0.02, 0};
  d.droplets.capacity = 2000;
  d.droplets.film_cells = 4;
  d.smoke.nx = d.smoke.ny = d.smoke.nz = 4;
  return d;
}

struct Scene {
  fluids::FluidsModel m = fluids::build(small());
  fluids::FluidsState s = initial_state(m);
  fluids::FluidsWork w = make_work(m);
  FluidDrawing drawing{m};

  render::Frame listed(std::span<const FilmPlace> places = {}, std::span<const float> floor = {}) {
    render::Frame frame;
    drawing.list({.state = s, .floor = floor, .places = places}, frame);
    return frame;
  }
  /// A jet of 1 mm^2 upwards with nothing to meet.
  void spurt(int ticks) {
    fluids::Outlet o;
    o.position = {0, 0, 0.02f}, o.direction = {0.6f, 0, 0.8f}, o.area = 1e-6;
    o.flow.blood = 1'200'000;
    for (int t = 0; t < ticks; ++t) {
      const fluids::FluidsInput in{{&o, 1}, {}, {}, {}, {}, {}, {}};
      begin_tick(m, in, s, w);
      for (int k = 0; k < w.droplets.questions; ++k) w.droplets.answers[std::size_t(k)] = {};
      finish_tick(m, in, s, w);
    }
  }
};

float to_axis(Vec3f p, const render::Splat& s) {
  const Vec3f way = s.to - s.from;
  const float all = dot(way, way), along = all > 0 ? std::clamp(dot(p - s.from, way) / all, 0.0f, 1.0f) : 0;
  return length(p - s.from - along * way);
}

TEST(FluidDrawing, ListsNothingWhereThereIsNothing) {
  Scene scene;
  const std::vector<FilmPlace> places(4);
  EXPECT_TRUE(scene.listed(places).liquid.empty());
}

TEST(FluidDrawing, WhatItListsPassesTheRenderersChecks) {
  Scene scene;
  scene.spurt(150);
  for (int k = 0; k < 9; ++k)
    pour(scene.m.pool, 15 + k % 3, 15 + k / 3, {.blood = kMillilitre / 99, .saline = kMillilitre / 99}, scene.s.pool);
  scene.s.droplets.film[2] = {50'000, 0, 0};
  const std::vector<FilmPlace> places(4);
  const render::Frame frame = scene.listed(places);
  ASSERT_FALSE(frame.liquid.splats.empty());
  ASSERT_FALSE(frame.liquid.triangles.empty());
  auto backend = render::make_null_backend();
  EXPECT_NO_THROW(draw_frame(*backend, frame, render::Target::off_screen(16, 16)));
}

TEST(FluidDrawing, AJetIsWholeAtItsHoleAndSprayFartherOff) {
  Scene scene;
  scene.spurt(90);
  const render::Frame frame = scene.listed();
  const fluids::DropletState& d = scene.s.droplets;
  const Vec3f hole{0, 0, 0.02f};
  std::vector<std::pair<std::uint32_t, Vec3f>> drops;
  std::size_t far = 0;
  for (std::size_t i = 0; i < std::size_t(d.count); ++i) {
    const Vec3f p{d.x[i], d.y[i], d.z[i]};
    if (length(p - hole) < 0.010f) drops.push_back({d.id[i], p});
    far += length(p - hole) > 0.05f;
  }
  std::sort(drops.begin(), drops.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  ASSERT_GE(drops.size(), 2u);
  ASSERT_GT(far, 3u);
  for (std::size_t n = 0; n + 1 < drops.size(); ++n)
    for (float share = 0; share <= 1; share += 0.1f) {
      const Vec3f p = (1 - share) * drops[n].second + share * drops[n + 1].second;
      float inside = 1;
      for (const render::Splat& s : frame.liquid.splats) inside = std::min(inside, to_axis(p, s) / s.radius);
      EXPECT_LT(inside, 0.9f) << "between drops " << n << " and " << n + 1;
    }
  std::size_t spray = 0;
  for (const render::Splat& s : frame.liquid.splats)
    spray += s.kind == render::SplatKind::streak && length(0.5f * (s.from + s.to) - hole) > 0.05f;
  EXPECT_GT(spray, 2 * far) << "each is drawn as shards";
}

TEST(FluidDrawing, TissueIsRedAroundAHoleThatSpurts) {
  Scene scene;
  scene.spurt(60);
  float nearest = 1;
  for (const render::Splat& s : scene.listed().liquid.splats)
    if (s.kind == render::SplatKind::film) nearest = std::min(nearest, length(s.from - Vec3f{0, 0, 0.02f}));
  EXPECT_LT(nearest, 0.003f);
}

TEST(FluidDrawing, WhatRunsDownAWallIsFilmAndNoPool) {
  Scene scene;
  const fluids::PoolModel& pool = scene.m.pool;
  std::vector<float> floor(std::size_t(pool.nx * pool.ny));
  const auto sheet_where_thin = [&](double rise) {
    for (int j = 0; j < pool.ny; ++j)
      for (int i = 0; i < pool.nx; ++i) floor[std::size_t(j * pool.nx + i)] = float(rise * i * pool.cell);
    int films = 0;
    const render::Frame frame = scene.listed({}, floor);
    for (const render::Splat& s : frame.liquid.splats) films += s.kind == render::SplatKind::film && s.height > 25e-6f;
    return std::pair{frame.liquid.triangles.size(), films};
  };
  for (int j = 10; j < 22; ++j)
    for (int i = 10; i < 22; ++i) pour(pool, i, j, {.blood = kMicrolitre / 2}, scene.s.pool);
  const auto [level_sheet, level_films] = sheet_where_thin(0);
  const auto [steep_sheet, steep_films] = sheet_where_thin(1.5);
  EXPECT_GT(level_sheet, 0u);
  EXPECT_EQ(level_films, 0);
  EXPECT_EQ(steep_sheet, 0u);
  EXPECT_GT(steep_films, 8);
}

TEST(FluidDrawing, SomeOfWhatRunsDownAWallRunsAheadInThinTongues) {
  Scene scene;
  const fluids::PoolModel& pool = scene.m.pool;
  std::vector<float> floor(std::size_t(pool.nx * pool.ny));
  for (int j = 0; j < pool.ny; ++j)
    for (int i = 0; i < pool.nx; ++i) floor[std::size_t(j * pool.nx + i)] = float(1.5 * i * pool.cell);
  for (int j = 6; j < 26; ++j)
    for (int i = 16; i < 22; ++i) pour(pool, i, j, {.blood = kMicrolitre / 2}, scene.s.pool);
  float film = 1, tongue = 1, thickest = 0;  // how far down they come
  for (const render::Splat& s : scene.listed({}, floor).liquid.splats)
    if (s.radius < 0.001f)
      tongue = std::min({tongue, s.from.z, s.to.z}), thickest = std::max(thickest, s.radius);
    else
      film = std::min({film, s.from.z, s.to.z});
  EXPECT_LT(tongue, film - 0.001f);
  EXPECT_GT(thickest, 0);
}

TEST(FluidDrawing, DropsSideBySideAreNoStrand) {
  Scene scene;
  for (int k = 0; k < 2; ++k)
    add_drop(scene.m.droplets, {0.003f * float(k), 0, 0.05f}, {0, 0, -1}, {.blood = kMicrolitre}, scene.s.droplets);
  const render::Frame frame = scene.listed();
  ASSERT_EQ(frame.liquid.splats.size(), 2u);
  for (const render::Splat& s : frame.liquid.splats) EXPECT_LT(std::fabs(s.from.x - s.to.x), 1e-6f);
}

TEST(FluidDrawing, ACapOfWaterHasItsDropsVolume) {
  Scene scene;
  fluids::DropletState& d = scene.s.droplets;
  add_drop(scene.m.droplets, {0, 0, 0.01f}, {0, 0, 0}, {.saline = 4 * kMicrolitre}, d);
  d.body[0] = 3;
  d.ground[0].offset = 0.01f;
  for (const float speed : {0.0f, 0.02f, 0.2f}) {
    d.vx[0] = speed;
    const render::Frame frame = scene.listed();
    ASSERT_EQ(frame.liquid.splats.size(), 1u);
    const render::Splat& s = frame.liquid.splats[0];
    EXPECT_EQ(s.kind, render::SplatKind::lying);
    // Its profile is a parabola across, and the same along its axis.
    const double a = double(s.radius), h = double(s.height), tail = double(length(s.to - s.from));
    const double volume = std::numbers::pi / 2 * h * a * a + 4.0 / 3 * a * h * tail;
    EXPECT_NEAR(volume, 4e-9, 0.05 * 4e-9) << speed;
    EXPECT_LT(h, 0.8 * a) << "no bead";
    EXPECT_NEAR(tail, speed > 0.1f ? 0.0032 : (speed > 0 ? 0.0011 : 0), 0.0006);
  }
}

/// Of a film: its height times (1 - r^2)^2, over its round ends and what is between.
double volume_of(const render::Splat& s) {
  const double reach = double(render::kSplatReach * s.radius), tail = double(length(s.to - s.from));
  return double(s.height) * (std::numbers::pi / 3 * reach * reach + 16.0 / 15 * reach * tail);
}

TEST(FluidDrawing, BloodThatLandsIsFilmOfItsVolumeWithATailUpTheWall) {
  Scene scene;
  fluids::DropletState& d = scene.s.droplets;
  add_drop(scene.m.droplets, {0.01f, 0, 0.02f}, {0, 0, 0}, {.blood = 4 * kMicrolitre}, d);
  d.body[0] = 3;
  d.ground[0].normal = {1, 0, 0}, d.ground[0].offset = 0.01f;
  double volume = 0, thickest = 0, head = 0, top = 0;
  for (const render::Splat& s : scene.listed().liquid.splats) {
    EXPECT_EQ(s.kind, render::SplatKind::film) << "no bead with a glint of its own";
    volume += volume_of(s);
    const double z = 0.5 * double(s.from.z + s.to.z);
    if (double(s.height) > thickest) thickest = double(s.height), head = z;
    top = std::max(top, z);
  }
  EXPECT_NEAR(volume, 4e-9, 0.05 * 4e-9);
  EXPECT_GT(top, head + 0.002) << "the tail is above the thick head";
}

TEST(FluidDrawing, AJetIsAnEvenRodNearItsHoleAndTornIntoUnevenPiecesFartherOff) {
  Scene scene;
  scene.spurt(90);
  struct Range {
    float least = 1, most = 0;
    void add(float x) { least = std::min(least, x), most = std::max(most, x); }
  } near, far;
  float faintest = 1;
  for (const render::Splat& s : scene.listed().liquid.splats) {
    if (s.kind != render::SplatKind::flying) continue;
    const float way = length(s.from - Vec3f{0, 0, 0.02f});
    if (way < 0.004f) near.add(s.radius);
    if (way > 0.03f) far.add(s.radius), faintest = std::min(faintest, s.height / s.radius);
  }
  ASSERT_GT(near.most, 0);
  EXPECT_LT(near.most, 1.5f * near.least);
  EXPECT_GT(far.most, 2 * far.least);
  EXPECT_LT(faintest, 0.1f) << "its pieces have soft ends";
}

TEST(FluidDrawing, SprayIsFaintAndThin) {
  Scene scene;
  scene.spurt(90);
  int streaks = 0, thin = 0;
  for (const render::Splat& s : scene.listed().liquid.splats) {
    if (s.kind != render::SplatKind::streak || length(s.from - Vec3f{0, 0, 0.02f}) < 0.03f) continue;
    ++streaks;
    EXPECT_LE(s.height, 120e-6f) << "what is smeared by its speed covers little";
    thin += s.radius <= 0.3e-3f && s.height <= 40e-6f;
  }
  EXPECT_GT(streaks, 10);
  EXPECT_GT(thin, streaks / 2);
}

TEST(FluidDrawing, ThreadsComeOffAJetOnItsWayOnlyAndFanOut) {
  Scene scene;
  scene.spurt(90);
  const render::Frame frame = scene.listed();
  const Vec3f hole{0, 0, 0.02f};
  // How far from every rod of the column.
  const auto aside = [&](const render::Splat& s) {
    float least = 1;
    for (const render::Splat& rod : frame.liquid.splats)
      if (rod.kind == render::SplatKind::flying) least = std::min(least, to_axis(0.5f * (s.from + s.to), rod));
    return least;
  };
  float near = 0, far = 0;
  int at_hole = 0;
  for (const render::Splat& s : frame.liquid.splats) {
    if (s.kind != render::SplatKind::streak) continue;
    const float way = length(0.5f * (s.from + s.to) - hole);
    at_hole += way < 0.004f;
    if (way < 0.015f) near = std::max(near, aside(s));
    if (way > 0.025f && way < 0.045f) far = std::max(far, aside(s));
  }
  EXPECT_EQ(at_hole, 0);
  EXPECT_GT(far, near);
}

TEST(FluidDrawing, ARivuletRunsDownFromAWoundAndHangsBelow) {
  // A rod of 3 mm along y; the hole is on its side, towards +x and up.
  constexpr float kRadius = 0.003f;
  const SurfaceNear rod = [](const FilmPlace& place) {
    const Vec3f out = normalised(Vec3f{place.position.x, 0, place.position.z}, Vec3f{0, 0, 1});
    FilmPlace on = place;
    on.position = Vec3f{0, place.position.y, 0} + kRadius * out, on.normal = out;
    return on;
  };
  render::Liquid liquid;
  const Vec3f out = normalised(Vec3f{1, 0, 0.5f}, Vec3f{});
  list_wound({}, {kRadius * out, out}, rod, liquid);
  float lowest = 1;
  for (const render::Splat& s : liquid.splats) {
    lowest = std::min(lowest, s.to.z);
    EXPECT_NEAR(std::hypot(s.to.x, s.to.z), kRadius, 0.0006f) << "it lies on the tissue";
  }
  EXPECT_LT(lowest, -0.9f * kRadius);
}

TEST(FluidDrawing, AFilmDarkensAsItClotsAndIsDarkFromTheFirstWhereItCameFromAVein) {
  Scene scene;
  for (std::size_t k = 0; k < 4; ++k) scene.s.droplets.film[k] = {60'000, 0, 0};
  const float now = now_of(scene.m.droplets, scene.s.droplets);
  for (int k = 0; k < 3; ++k) scene.s.droplets.film_blood[std::size_t(k)].born = now - 120.0f * float(k);
  scene.s.droplets.film_blood[3] = {now, 1};
  const std::vector<FilmPlace> places(4);
  const render::Frame frame = scene.listed(places);
  ASSERT_EQ(frame.liquid.splats.size(), 4u);
  EXPECT_EQ(frame.liquid.splats[0].dark, 0);
  EXPECT_EQ(frame.liquid.splats[1].dark, 0);
  EXPECT_NEAR(frame.liquid.splats[2].dark, 0.5f, 0.01f);  // 240 s: half-way from 180 to 300
  EXPECT_NEAR(frame.liquid.splats[3].dark, 0.6f, 0.01f);
}

TEST(FluidDrawing, AFilmRunsDownhillThroughItsPlaceAndLiesRoundWhereItIsLevel) {
  Scene scene;
  scene.s.droplets.film[0] = scene.s.droplets.film[1] = {200'000, 0, 0};
  std::vector<FilmPlace> places(2);
  places[0].area = places[1].area = 20e-6f;
  places[1].normal = {1, 0, 0};
  const render::Frame frame = scene.listed(places);
  ASSERT_EQ(frame.liquid.splats.size(), 2u);
  const render::Splat &level = frame.liquid.splats[0], &steep = frame.liquid.splats[1];
  EXPECT_LT(length(level.to - level.from), 1e-5f);
  const Vec3f way = steep.to - steep.from;
  EXPECT_GT(length(way) + 2 * steep.radius, std::sqrt(20e-6f)) << "it reaches the next place";
  EXPECT_GT(std::fabs(way.z), 0.9f * length(way));
  EXPECT_LT(steep.radius, level.radius);
}

TEST(FluidDrawing, ThePoolsSurfaceIsTheSimulationsAndEndsWithIt) {
  Scene scene;
  const fluids::PoolModel& pool = scene.m.pool;
  for (int j = 10; j < 22; ++j)
    for (int i = 10; i < 22; ++i) pour(pool, i, j, {.blood = 3 * kMicrolitre, .saline = kMicrolitre}, scene.s.pool);
  const float depth = depth_at(pool, scene.s.pool, 15, 15);
  const render::Frame frame = scene.listed();
  const render::Liquid& liquid = frame.liquid;
  ASSERT_FALSE(liquid.triangles.empty());
  int middle = 0;
  for (const render::SheetVertex& v : liquid.sheet) {
    const double x = (double(v.position.x) + 0.02) / pool.cell, y = (double(v.position.y) + 0.02) / pool.cell;
    const double beyond = std::max(std::max(10 - x, x - 22), std::max(10 - y, y - 22));
    if (beyond > 2.5) {
      EXPECT_LT(v.cover, 1.0f / 3);
    }
    if (beyond < 0) {
      EXPECT_GE(v.cover, 1.0f / 3);
    }
    if (beyond > -4) continue;
    ++middle;
    EXPECT_NEAR(v.position.z, depth, 1e-5f);
    EXPECT_NEAR(v.depth, depth, 1e-5f);
    EXPECT_NEAR(v.share_b, 0.25f, 1e-5f);
    EXPECT_GT(v.normal.z, 0.9999f);
  }
  EXPECT_GT(middle, 8);
}

TEST(FluidDrawing, NonsenseIsLeftOut) {
  Scene scene;
  fluids::DropletState& d = scene.s.droplets;
  add_drop(scene.m.droplets, {0, 0, 0.05f}, {0, 0, -1}, {.blood = kMicrolitre}, d);
  add_drop(scene.m.droplets, {0.01f, 0, 0.05f}, {0, 0, -1}, {.blood = kMicrolitre}, d);
  d.x[0] = std::numeric_limits<float>::quiet_NaN();
  d.film[0] = {50'000, 0, 0};
  std::vector<FilmPlace> places(4);
  places[0].position.y = std::numeric_limits<float>::infinity();
  EXPECT_EQ(scene.listed(places).liquid.splats.size(), 1u);
}

TEST(SmokeDrawing, ClearAirGivesNoneAndSmokeAGridLikeTheSimulations) {
  Scene scene;
  render::Frame frame;
  list_smoke(scene.m.smoke, scene.s.smoke, frame);
  EXPECT_TRUE(frame.smoke.empty());
  std::fill(scene.s.smoke.density.begin(), scene.s.smoke.density.end(), 2.0f);
  list_smoke(scene.m.smoke, scene.s.smoke, frame);
  ASSERT_EQ(frame.smoke.density.size(), 64u);
  for (const float d : frame.smoke.density) EXPECT_FLOAT_EQ(d, 2) << "mixed smoke hangs nowhere thicker";
  EXPECT_FLOAT_EQ(frame.smoke.kappa, float(scene.m.smoke.kappa));
}

TEST(SmokeDrawing, NewSmokeHangsAsAVeilAndGoesAsItGoes) {
  Scene scene;
  render::Frame frame, thinner, fogged;
  scene.s.smoke.density[5] = 2;
  list_smoke(scene.m.smoke, scene.s.smoke, frame);
  const auto all = [](const render::Frame& f) {
    return std::accumulate(f.smoke.density.begin(), f.smoke.density.end(), 0.0f);
  };
  for (const float d : frame.smoke.density) EXPECT_GT(d, 0);
  EXPECT_GT(all(frame), 2);
  scene.s.smoke.density[5] = 0.2f;
  list_smoke(scene.m.smoke, scene.s.smoke, thinner);
  EXPECT_NEAR(all(thinner), 0.1f * all(frame), 1e-4f) << "all of it follows the State";
  scene.s.smoke.density[5] = 2;
  scene.s.smoke.fog = 0.6;
  list_smoke(scene.m.smoke, scene.s.smoke, fogged);
  EXPECT_NEAR(all(fogged), 2, 1e-4f) << "none on top of fog";
}

/// Rising along u.
std::vector<float> slope(const fluids::PoolModel& m) {
  std::vector<float> floor;
  for (int j = 0; j < m.ny; ++j)
    for (int i = 0; i < m.nx; ++i) floor.push_back(0.5f * float(m.cell) * float(i));
  return floor;
}

TEST(BloodRun, FollowsTheFallAndGrowsWhileTheWoundBleeds) {
  Scene scene;
  const std::vector<float> floor = slope(scene.m.pool);
  render::Liquid young, old;
  list_run({.wound = {0.012, 0, 0.03}, .since = 0.5}, scene.m.pool, scene.s.pool, floor, young);
  list_run({.wound = {0.012, 0, 0.03}, .since = 1.5}, scene.m.pool, scene.s.pool, floor, old);
  ASSERT_GT(young.splats.size(), 3u);
  EXPECT_GT(old.splats.size(), 2 * young.splats.size());
  for (const render::Splat& s : old.splats) {
    EXPECT_LT(s.to.x, s.from.x);
    EXPECT_LT(s.to.z, s.from.z);
    EXPECT_NEAR(length(s.normal), 1, 1e-5);
  }
}

TEST(BloodRun, IsNoneOnLevelGround) {
  Scene scene;
  render::Liquid liquid;
  list_run({.wound = {0, 0, 0.03}, .since = 5}, scene.m.pool, scene.s.pool, {}, liquid);
  EXPECT_TRUE(liquid.splats.empty());
}

TEST(Lens, IsCleanUntilItFogs) {
  Scene scene;
  Lens lens;
  render::Frame frame;
  lens.list(scene.m.smoke, scene.s.smoke, frame);
  EXPECT_TRUE(frame.look.soil.clean());
  scene.s.smoke.fog = 0.4;
  lens.list(scene.m.smoke, scene.s.smoke, frame);
  EXPECT_FLOAT_EQ(frame.look.soil.fog, 0.4f);
}

TEST(Lens, ASmearIsAsOldAsItsWipeHoweverRarelyOneLooksAndGoneForWhoGoesBack) {
  const auto smear_at = [](std::initializer_list<std::uint64_t> ticks) {  // of a wipe from 1 to 9 s
    Scene scene;
    Lens lens;
    float smear = 0;
    for (const std::uint64_t tick : ticks) {
      render::Frame frame;
      frame.tick = tick;
      const bool wiping = tick >= 1000 && tick < 9000;
      scene.s.smoke.wipe_left = wiping ? 1e-3 * double(9000 - tick) : 0;
      lens.list(scene.m.smoke, scene.s.smoke, frame);
      smear = frame.look.soil.smear;
    }
    return smear;
  };
  const float often = smear_at({0, 2000, 5000, 8000, 8900, 8980, 9000, 9500, 10'000, 12'000});
  EXPECT_GT(often, 0.1f);
  EXPECT_NEAR(smear_at({0, 2000, 12'000}), often, 1e-4f);
  EXPECT_EQ(smear_at({0, 2000, 12'000, 500}), 0);
  EXPECT_EQ(smear_at({0, 2000, 12'000, 500, 900}), 0);
}

TEST(Lens, AWipeTakesFogAndDropsAndItsSmearThinsOut) {
  Scene scene;
  Lens lens;
  lens.splash(1, {.blood = 1}, 3);
  scene.s.smoke.fog = 0.9;
  int drops = 0, strokes = 0;
  float before = -1;
  for (int t = 0; t < 8000; t += 20) {
    render::Frame frame;
    frame.tick = std::uint64_t(t);
    scene.s.smoke.wipe_left = scene.m.smoke.wipe_time * (1 - t / 8000.0);
    lens.list(scene.m.smoke, scene.s.smoke, frame);
    const render::LensSoil& soil = frame.look.soil;
    if (t == 0) drops = soil.drop_count;
    strokes += soil.wipe < before;
    before = soil.wipe;
    if (t > 3000) {
      EXPECT_EQ(soil.drop_count, 0) << t;
    }
    if (t > 3000) {
      EXPECT_EQ(soil.fog, 0) << t;
    }
  }
  EXPECT_GT(drops, 0);
  EXPECT_EQ(strokes, 2);  // three strokes
  scene.s.smoke.fog = scene.s.smoke.wipe_left = 0;
  render::Frame after;
  after.tick = 8100;
  lens.list(scene.m.smoke, scene.s.smoke, after);
  EXPECT_LT(after.look.soil.wipe, 0);
  EXPECT_GT(after.look.soil.smear, 0.2f);
  render::Frame later;
  later.tick = 40000;
  lens.list(scene.m.smoke, scene.s.smoke, later);
  EXPECT_TRUE(later.look.soil.clean());
}

}  // namespace
}  // namespace trocar::view
