// What lies in a pool before anything begins: level, booked to the picolitre, in the deepest hollow first.
#include <algorithm>

#include <gtest/gtest.h>

#include <trocar/fluids/pool_fill.hpp>

namespace trocar::fluids {
namespace {

constexpr int kWide = 32;

/// Two hollows in a plate, the left one deeper, with a ridge between them.
struct Hollows {
  PoolModel pool = build(PoolDescription{.nx = kWide, .ny = kWide, .cell = 0.002});
  std::vector<float> floor = std::vector<float>(kWide * kWide, 0.030f);
  PoolState state = empty_pool(pool);

  Hollows() {
    for (int j = 8; j < 24; ++j)
      for (int i = 4; i < 28; ++i) floor[size_t(j * kWide + i)] = i < 14 ? 0.0f : i < 18 ? 0.012f : 0.004f;
  }
  double surface(int i, int j) const { return double(floor_at(pool, floor, i, j) + depth_at(pool, state, i, j)); }
  Mix poured(double millilitres) {
    return fill_level(pool, floor, {.blood = std::int64_t(millilitres * double(kMillilitre))}, state);
  }
};

TEST(PoolFill, LiesLevelInTheDeepestHollowAndIsAllThere) {
  Hollows p;
  const Mix in = p.poured(3);
  EXPECT_EQ(in.blood, 3 * kMillilitre);
  EXPECT_EQ(content(p.pool, p.state), in) << "to the picolitre";
  for (int j = 8; j < 24; ++j)
    for (int i = 4; i < 14; ++i) EXPECT_NEAR(p.surface(i, j), p.surface(4, 8), 1e-6);
  EXPECT_EQ(depth_at(p.pool, p.state, 20, 12), 0) << "the other hollow is behind a ridge";
}

TEST(PoolFill, RunsOverARidgeAndStandsLevelInBothHollows) {
  Hollows p;
  EXPECT_EQ(p.poured(20).blood, 20 * kMillilitre);
  EXPECT_GT(p.surface(6, 12), 0.012);
  for (const int i : {4, 10, 15, 20, 27}) EXPECT_NEAR(p.surface(i, 12), p.surface(6, 12), 1e-6);
}

TEST(PoolFill, StaysAsItLiesWhenTimeGoesOn) {
  Hollows p;
  Ledger ledger;
  receive(ledger, Source::kBled, Place::kPool, p.poured(15));
  const PoolState before = p.state;
  PoolWork work = make_work(p.pool);
  for (int tick = 0; tick < 400; ++tick) advance(p.pool, {p.floor, {}, {}}, p.state, work, ledger);
  EXPECT_EQ(content(p.pool, p.state), content(p.pool, before));
  for (const int i : {4, 10, 20, 27})
    EXPECT_NEAR(depth_at(p.pool, p.state, i, 12), depth_at(p.pool, before, i, 12), 2e-5);
}

TEST(PoolFill, WhatTheFieldHasNoRoomForIsNotPoured) {
  Hollows p;
  const Mix in = p.poured(500);
  EXPECT_LT(in.blood, 500 * kMillilitre);
  EXPECT_EQ(content(p.pool, p.state), in);
}

}  // namespace
}  // namespace trocar::fluids
