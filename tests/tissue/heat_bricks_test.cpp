// Bricks that wake and sleep: nothing of what they do depends on where they lie in memory, on scratch, or on when a
// state was saved.
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "heat_setup.hpp"

namespace trocar::tissue::test {
namespace {

HeatSource coagulating(Vec3d at, BodyId body = BodyId::strand(0), double watts = 15) {
  return {.body = body, .a = at, .b = at, .radius = 1e-3, .reach = 2, .watts = watts};
}

/// A hook that wanders, stops, and comes back.
HeatSource wandering(int tick) {
  const double x = 4e-3 * ((tick / 500) % 5) - 8e-3;
  return coagulating({x, 1e-3 * (tick / 2500), -0.3e-3}, BodyId::strand(0), tick % 2500 < 1500 ? 20 : 0);
}

TEST(HeatBricks, CooledTissueSleepsAndKeepsWhatHappenedToIt) {
  Heated h(HeatDescription{}, half_space());
  const HeatSource q = coagulating(kJustBelow);
  h.run(2, {&q, 1});
  const HeatReading hot = reading(h.m, h.s, BodyId::strand(0), kTopCells);
  EXPECT_GT(hot.coagulated, 0.99f);
  EXPECT_LT(hot.water, 0.9f);
  h.run(150);
  EXPECT_EQ(bricks_awake(h.s), 0);
  EXPECT_GT(bricks_used(h.s), 0);
  EXPECT_LT(std::fabs(h.imbalance()), 1e-5);
  EXPECT_GT(h.s.books.dropped, 0);
  EXPECT_LT(h.s.books.dropped, 0.15 * h.s.books.given);
  std::printf("    dropped by falling asleep: %.2f %% of what was given, conducted beyond: %.2f %%\n",
              100 * h.s.books.dropped / h.s.books.given, 100 * h.s.books.conducted / h.s.books.given);
  const HeatReading asleep = reading(h.m, h.s, BodyId::strand(0), kTopCells);
  EXPECT_EQ(asleep.temperature, 37);
  EXPECT_LT(asleep.water, hot.water + 1e-6f);
  EXPECT_GE(asleep.coagulated, hot.coagulated);

  const HeatSource little = coagulating(kJustBelow, BodyId::strand(0), 2);
  h.run(0.1, {&little, 1});
  EXPECT_GT(bricks_awake(h.s), 0);
  EXPECT_GE(reading(h.m, h.s, BodyId::strand(0), kTopCells).coagulated, asleep.coagulated);
}

TEST(HeatBricks, WhatWasOnlyWarmIsForgotten) {
  Heated h(HeatDescription{}, half_space());
  const HeatSource q = coagulating(kJustBelow, BodyId::strand(0), 0.05);
  h.run(3, {&q, 1});
  EXPECT_GT(h.celsius(kTopCells), 39);
  EXPECT_GT(bricks_used(h.s), 0);
  h.run(60);
  EXPECT_EQ(bricks_used(h.s), 0);
  EXPECT_LT(std::fabs(h.imbalance()), 1e-4);
}

TEST(HeatBricks, WhereABrickLiesInMemoryChangesNoBit) {
  Heated alone(HeatDescription{}, half_space()), crowded(HeatDescription{}, half_space());
  for (int t = 0; t < 400; ++t) {
    const HeatSource other = coagulating({0.011, -0.007, -1e-3}, BodyId::strand(3));
    crowded.tick({&other, 1});
  }
  for (int t = 0; t < 400; ++t) alone.tick();
  for (int t = 0; t < 6000; ++t) {
    const HeatSource both[] = {coagulating({0.011, -0.007, -1e-3}, BodyId::strand(3), t % 1000 < 300 ? 15 : 0),
                               wandering(t)};
    alone.tick({both + 1, 1});
    crowded.tick(both);
  }
  int compared = 0;
  for (double x = -0.012; x < 0.012; x += 0.4e-3)
    for (double z = -4e-3; z < 0; z += 0.4e-3) {
      const HeatReading a = reading(alone.m, alone.s, BodyId::strand(0), {x, 0.5e-3, z});
      const HeatReading b = reading(crowded.m, crowded.s, BodyId::strand(0), {x, 0.5e-3, z});
      ASSERT_EQ(std::memcmp(&a, &b, sizeof a), 0) << x << " " << z;
      compared += a.temperature > 40;
    }
  EXPECT_GT(compared, 50);
}

TEST(HeatBricks, ABordersPlaceIsNotSeen) {
  const double shift = 0.5e-3 * kBrickSide / 2;
  Heated a(HeatDescription{}), b(HeatDescription{});
  const HeatSource at_corner = coagulating({0, 0, 0}), in_middle = coagulating({shift, shift, shift});
  for (int t = 0; t < 3000; ++t) {
    a.tick({&at_corner, 1});
    b.tick({&in_middle, 1});
  }
  for (double r = 0; r < 4e-3; r += 0.1e-3)
    EXPECT_NEAR(a.celsius({r, 0.3 * r, 0}), b.celsius({r + shift, 0.3 * r + shift, shift}), 5e-2) << r;
}

TEST(HeatBricks, ScratchFullOfNanChangesNoBit) {
  Heated clean(HeatDescription{}, half_space()), dirty(HeatDescription{}, half_space());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (int t = 0; t < 4000; ++t) {
    const HeatSource q = wandering(t);
    std::fill(dirty.w.u.begin(), dirty.w.u.end(), nan);
    std::fill(dirty.w.conduction.begin(), dirty.w.conduction.end(), nan);
    std::fill(dirty.w.boiled.begin(), dirty.w.boiled.end(), nan);
    std::fill(dirty.w.weight.begin(), dirty.w.weight.end(), nan);
    std::fill(dirty.w.touched.begin(), dirty.w.touched.end(), -1);
    clean.tick({&q, 1});
    dirty.tick({&q, 1});
    if (t % 500 == 0) {
      ASSERT_EQ(clean.hash(), dirty.hash()) << t;
    }
  }
  EXPECT_EQ(clean.hash(), dirty.hash());
}

TEST(HeatBricks, AStateSavedAtAnyTickContinuesWithTheSameBits) {
  Heated h(HeatDescription{}, half_space());
  std::vector<HeatState> saved;
  std::vector<int> at = {1, 733, 2501, 4004, 9999};  // within steps, awake and falling asleep
  for (int t = 0; t < 14000; ++t) {
    if (std::find(at.begin(), at.end(), t) != at.end()) saved.push_back(h.s);
    const HeatSource q = wandering(t);
    h.tick(t < 6000 ? std::span<const HeatSource>(&q, 1) : std::span<const HeatSource>());
  }
  for (std::size_t n = 0; n < at.size(); ++n) {
    Heated again(HeatDescription{}, half_space());
    again.s = saved[n];
    for (int t = at[n]; t < 14000; ++t) {
      const HeatSource q = wandering(t);
      again.tick(t < 6000 ? std::span<const HeatSource>(&q, 1) : std::span<const HeatSource>());
    }
    EXPECT_EQ(again.hash(), h.hash()) << "saved at " << at[n];
  }
}

TEST(HeatBricks, BitsAreThoseOfEveryCompiler) {
  Heated h(HeatDescription{}, half_space());
  for (int t = 0; t < 3003; ++t) {
    const HeatSource q = wandering(t);
    h.tick({&q, 1});
  }
  EXPECT_EQ(h.hash(), 2413148363633624117ull);
}

TEST(HeatBricks, FullMeansSaidAndBookedNotLost) {
  HeatDescription d;
  d.bricks = 6;
  d.awake = 4;
  Heated h(d);
  const HeatSource q = coagulating({0, 0, 0}, BodyId::strand(0), 20);
  h.run(8, {&q, 1});
  const HeatSource elsewhere = coagulating({0.01, 0.01, 0.01});
  for (int t = 0; t < 8; ++t) h.tick({&elsewhere, 1});
  EXPECT_TRUE(h.flags & HeatReport::kAwakeFull);
  EXPECT_LT(std::fabs(h.imbalance()), 1e-4);
  EXPECT_LE(bricks_awake(h.s), 4);

  HeatDescription one = d;
  one.bricks = one.awake = 1;
  Heated lone(one);
  lone.run(2, {&q, 1});
  EXPECT_TRUE(lone.flags & HeatReport::kBricksFull);
  EXPECT_GT(lone.s.books.conducted, 0);
  EXPECT_LT(std::fabs(lone.imbalance()), 1e-4);
}

TEST(HeatBricks, TissueIsAskedForOncePerBrick) {
  static int asked;
  asked = 0;
  const TissueShape counting{
      nullptr, [](const void* c, BodyId body, Vec3d corner, double cell, std::span<std::uint8_t> tissue) noexcept {
        ++asked;
        fill_below(c, body, corner, cell, tissue);
      }};
  Heated h(HeatDescription{}, counting);
  const HeatSource q = coagulating(kJustBelow);
  h.run(4, {&q, 1});
  EXPECT_EQ(asked, bricks_used(h.s) + h.s.empties);
  EXPECT_GT(h.s.empties, 0);
}

TEST(HeatBricks, EveryTickDoesItsShare) {
  Heated h(HeatDescription{}, half_space());
  const HeatSource q = coagulating(kJustBelow, BodyId::strand(0), 20);
  h.run(8, {&q, 1});
  int least = 1000, most = 0, all = 0;
  for (int t = 0; t < h.m.period; ++t) {
    const int worked = advance(h.m, {&q, 1}, h.shape, h.s, h.w).worked;
    least = std::min(least, worked);
    most = std::max(most, worked);
    all += worked;
  }
  EXPECT_GT(all, 12);
  EXPECT_LE(most - least, 1);
}

TEST(HeatBricks, WarmthOfTheEdgeThatIsNotComputedHardlyMatters) {
  HeatDescription coarse, fine;
  fine.wake = 0.05;
  fine.sleep = 0.02;
  fine.bricks = fine.awake = 1024;
  Heated a(coarse, half_space()), b(fine, half_space());
  const HeatSource q = coagulating(kJustBelow, BodyId::strand(0), 15);
  const HeatSource off = coagulating(kJustBelow, BodyId::strand(0), 0);
  for (int t = 0; t < 10000; ++t) {
    a.tick({t < 4000 ? &q : &off, 1});
    b.tick({t < 4000 ? &q : &off, 1});
  }
  const double r = a.spread_of(45, kTopCells), wanted = b.spread_of(45, kTopCells);
  expect_within("45 C, waking at 1 K beside 0.05 K", "f32", r / wanted - 1, 0.01);
  EXPECT_LT(bricks_awake(a.s), bricks_awake(b.s));
}

}  // namespace
}  // namespace trocar::tissue::test
