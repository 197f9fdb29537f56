// The whole: tools, the account at every tick, determinism, the law of scratch.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <thread>

#include <gtest/gtest.h>

#include "plates.hpp"

namespace trocar::fluids {
namespace {

using test::Scene;
using test::small_scene;

/// An artery that spurts on a slope, oozing, irrigation and suction, an instrument that stirs, smoke, a heaving floor.
void stir(Scene& b, int t) {
  const double beat = 0.6 + 0.4 * std::sin(0.0075 * t);
  Outlet ooze;
  ooze.flow = {.blood = 3000, .bile = 800}, ooze.film = 5, ooze.area = 1e-6;
  b.openings = {test::bleeding({-0.03f, 0, 0.07f}, {0.6f, 0, 0.8f}, 3e-6 * beat, 2e-6), ooze};
  b.plates = {
      {.centre = {-0.02f, 0, 0.05f}, .normal = {0.6f, 0, 0.8f}, .radius = 0.03f, .first_film = 0, .film_cells = 40}};
  const float sway = 0.02f * float(std::sin(0.004 * t));
  b.tools = {{.tip = {0.03f, sway, 0.03f},
              .direction = {0, 0, -1},
              .irrigation = t % 700 < 300 ? 1.0 : 0.0,
              .suction = t % 700 >= 350 ? 1.0 : 0.0,
              .blocked = t % 900 > 850}};
  if (t % 700 >= 350) b.tools[0].tip.z = 0.004f;
  b.capsules = {{.a = {sway, -0.02f, 0.002f}, .b = {0, -0.05f, 0.2f}, .radius = 0.0025f, .body = 9}};
  for (std::size_t c = 0; c < b.floor.size(); ++c)
    b.floor[c] = 0.002f * float(std::sin(0.002 * t + 0.1 * double(c % 64)));
  b.boiled = {{{0, 0, 0.04}, 5e-9}};
  b.smoke = {.coagulating = t % 500 < 250, .wipe = t == 800, .lens = {0, 0.05, 0.1}};
}

TEST(Fluids, AccountForEveryPicolitreAtEveryTick) {
  Scene b(small_scene());
  std::uint32_t flags = 0;
  Mix sucked;
  for (int t = 0; t < 3000; ++t) {
    stir(b, t);
    const FluidsReport r = b.tick();
    flags |= r.report.flags;
    sucked += r.tools[0].sucked;
    ASSERT_TRUE(audit(b.m, b.s)) << t;
  }
  EXPECT_EQ(flags & ~std::uint32_t(FluidReport::kCrowded), 0u);
  EXPECT_EQ(sucked, at(b.s.ledger, Place::kSucked));
  EXPECT_GT(b.millilitres(Place::kPool), 5);
  EXPECT_GT(b.millilitres(Place::kSucked), 0.05);
  EXPECT_GT(b.millilitres(Place::kFilm), 0.001);
  EXPECT_GT(b.s.ledger.in[0].bile, 0);
}

TEST(Fluids, TheSameInputsGiveTheSameBitsWhateverIsInTheScratch) {
  Scene a(small_scene()), b(small_scene());
  for (int t = 0; t < 1200; ++t) {
    stir(a, t), stir(b, t);
    a.tick();
    poison(b.w);
    b.tick();
    if (t % 20 == 0) {
      ASSERT_EQ(a.hash(), b.hash()) << t;
    }
  }
  EXPECT_EQ(a.hash(), b.hash());
}

TEST(Fluids, AStateSavedAtAnyTickGoesOnWithTheSameBits) {
  Scene a(small_scene());
  for (int t = 0; t < 777; ++t) stir(a, t), a.tick();
  Scene b(small_scene());
  b.s = a.s;
  for (int t = 777; t < 1100; ++t) {
    stir(a, t), stir(b, t);
    a.tick(), b.tick();
  }
  EXPECT_EQ(a.hash(), b.hash());
}

TEST(Fluids, OneModelServesTwoThreadsAndAnotherInputGivesAnotherState) {
  std::uint64_t hash[3];
  const auto run = [&hash](int which) {
    Scene b(small_scene());
    for (int t = 0; t < 400; ++t) {
      stir(b, t);
      if (which == 2 && t == 10) b.openings[0].flow.blood += 1;
      b.tick();
    }
    hash[which] = b.hash();
  };
  std::thread one(run, 0), other(run, 1);
  one.join(), other.join();
  run(2);
  EXPECT_EQ(hash[0], hash[1]);
  EXPECT_NE(hash[0], hash[2]);
}

Scene flooded(double depth, int n = 64) {
  FluidsDescription d = small_scene();
  d.pool.nx = d.pool.ny = n;
  d.pool.cell = 0.16 / n;
  Scene b(d);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const Mix mix{.saline = std::int64_t(depth * b.m.pool.cell * b.m.pool.cell * kPicolitresPerM3)};
      receive(b.s.ledger, Source::kIrrigated, Place::kPool, mix);
      pour(b.m.pool, i, j, mix, b.s.pool);
    }
  return b;
}

TEST(Suction, TakesALitreOrTwoAMinuteFromThePoolAndElseGas) {
  Scene b = flooded(0.01);
  b.tools = {{.tip = {0, 0, 0.008f}, .suction = 1}};
  double gas = 0;
  for (int t = 0; t < 1000; ++t) gas += b.tick().tools[0].gas_flow * 1e-3;
  const double per_minute = b.millilitres(Place::kSucked) * 60;
  EXPECT_GT(per_minute, 1000);
  EXPECT_LT(per_minute, 2000);
  EXPECT_LT(gas, 1e-4);
  b.tools[0].tip.z = 0.06f;  // out of the water
  const Mix before = at(b.s.ledger, Place::kSucked);
  for (int t = 0; t < 100; ++t) EXPECT_NEAR(b.tick().tools[0].gas_flow, 25e-3 / 60, 1e-12);
  EXPECT_EQ(at(b.s.ledger, Place::kSucked), before);
}

TEST(Suction, LowersThePool) {
  Scene b = flooded(0.004);
  b.tools = {{.tip = {0, 0, 0.001f}, .suction = 1}};
  double gas = 0;
  for (int t = 0; t < 4000; ++t) gas += b.tick().tools[0].gas_flow * 1e-3;
  EXPECT_LT(b.millilitres(Place::kPool), 65);
  EXPECT_GT(gas, 1e-6) << "air is drawn in as fluid does not run up fast enough";
  EXPECT_TRUE(audit(b.m, b.s));
}

TEST(Suction, ClogsOnTissueAndTakesNothing) {
  Scene b = flooded(0.01);
  b.tools = {{.tip = {0, 0, 0.008f}, .suction = 1, .blocked = true}};
  for (int t = 0; t < 20; ++t) {
    const FluidsReport r = b.tick();
    EXPECT_TRUE(r.tools[0].clogged);
    EXPECT_EQ(r.tools[0].gas_flow, 0);
  }
  EXPECT_TRUE(at(b.s.ledger, Place::kSucked).empty());
}

TEST(Suction, CatchesDropsWithinFiveMillimetres) {
  Scene b(small_scene());
  for (const float x : {0.004f, 0.007f}) {
    ASSERT_TRUE(add_drop(b.m.droplets, {x, 0, 0.05f}, {0, 0, 0}, {.blood = 1'000'000}, b.s.droplets));
    receive(b.s.ledger, Source::kBled, Place::kDroplets, {.blood = 1'000'000});
  }
  b.tools = {{.tip = {0, 0, 0.05f}, .suction = 1}};
  b.tick();
  EXPECT_EQ(at(b.s.ledger, Place::kSucked).blood, 1'000'000);
  EXPECT_EQ(b.s.droplets.count, 1);
}

TEST(Irrigation, DilutesThePool) {
  Scene b(small_scene());
  for (int j = 24; j < 40; ++j)
    for (int i = 24; i < 40; ++i) {
      receive(b.s.ledger, Source::kBled, Place::kPool, {.blood = 40'000'000});
      pour(b.m.pool, i, j, {.blood = 40'000'000}, b.s.pool);
    }
  b.tools = {{.tip = {0, 0, 0.04f}, .direction = {0, 0, -1}, .irrigation = 1}};
  for (int t = 0; t < 3000; ++t) b.tick();
  EXPECT_NEAR(double(b.s.ledger.in[1].saline), 1e-3 / 60 * 3 * 1e15, 10);
  const Mix middle = mix_at(b.m.pool, b.s.pool, 32, 32);
  EXPECT_LT(double(middle.blood), 0.5 * double(middle.total()));
  EXPECT_TRUE(audit(b.m, b.s));
}

TEST(Irrigation, DoesNotHeapUpUnderTheJet) {
  for (const int n : {64, 128})
    for (const double depth : {0.003, 0.010, 0.030}) {
      Scene b = flooded(depth, n);
      b.tools = {{.tip = {0, 0, float(depth) + 0.03f}, .direction = {0, 0, -1}, .irrigation = 1}};
      double highest = 0;
      int most = 0;
      for (int t = 0; t < 3000; ++t) {
        b.tick();
        most = std::max(most, b.s.droplets.count);
        if (t % 10 != 0) continue;
        const double level = b.millilitres(Place::kPool) * 1e-6 / (0.16 * 0.16);
        for (int j = 0; j < n; ++j)
          for (int i = 0; i < n; ++i) highest = std::max(highest, double(depth_at(b.m.pool, b.s.pool, i, j)) - level);
      }
      std::printf("  highest above the level, cells of %.2f mm, %.0f mm deep: %.1f mm; up to %d drops\n", 160.0 / n,
                  1e3 * depth, 1e3 * highest, most);
      EXPECT_LT(highest, 0.018) << "2.4 m/s could throw it 0.3 m up";
    }
}

}  // namespace
}  // namespace trocar::fluids
