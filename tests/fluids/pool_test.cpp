// The pool against closed forms and a measured dam break; what must hold of it whatever happens.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/fluids/pool.hpp>
#include <trocar/fluids/pool_kernels.hpp>
#include <trocar/numerics/portable.hpp>

#include "within.hpp"

namespace trocar::fluids {
namespace {

/// A pool with all it needs; fluid that is poured in is booked as bled.
struct Basin {
  PoolModel m;
  PoolState s;
  PoolWork w;
  Ledger ledger;
  std::vector<float> floor;

  explicit Basin(const PoolDescription& d, double tick = 1e-3)
      : m(build(d, tick)), s(empty_pool(m)), w(make_work(m)), floor(std::size_t(d.nx) * d.ny, 0.0f) {}

  void fill(int i, int j, const Mix& mix) {
    receive(ledger, Source::kBled, Place::kPool, mix);
    pour(m, i, j, mix, s);
  }
  void fill_to(int i, int j, double depth) {
    fill(i, j, {.blood = std::int64_t(depth * m.cell * m.cell * kPicolitresPerM3)});
  }
  void splash(int i, int j, std::int64_t saline, Vec3f v) {
    receive(ledger, Source::kIrrigated, Place::kPool, {.saline = saline});
    fall_into(m, floor, i, j, 0.003f, {.saline = saline}, v, s);
  }
  FluidReport tick(std::span<const Capsule> capsules = {}, std::span<const Drain> drains = {}) {
    return advance(m, {.floor = floor, .capsules = capsules, .drains = drains}, s, w, ledger);
  }
  double depth(int i, int j) const { return double(depth_at(m, s, i, j)); }
};

PoolDescription channel(int nx, double cell) {
  PoolDescription d;
  d.nx = nx;
  d.ny = 2;
  d.cell = cell;
  d.period = 1;
  return d;
}

// ---- [Martin & Moyce 1952], square-based column a wide and 2a high, a = 57.15 mm: T = t sqrt(2 g / a), Z = x / a;
// tau = t sqrt(g / a), H = y / 2a.

struct Reading {
  double time, value;
};
constexpr Reading kFront[] = {{0.41, 1.11}, {0.84, 1.22}, {1.19, 1.44}, {1.43, 1.67}, {1.63, 1.89},
                              {1.83, 2.11}, {1.98, 2.33}, {2.20, 2.56}, {2.32, 2.78}, {2.51, 3.00},
                              {2.65, 3.22}, {2.83, 3.44}, {2.98, 3.67}, {3.11, 3.89}, {3.33, 4.11}};
constexpr Reading kHeight[] = {{0.56, 0.94}, {0.93, 0.83}, {1.28, 0.72}, {1.66, 0.61}, {2.00, 0.50}};

struct Collapse {
  std::vector<Reading> front, height;
};

/// The front is where 2 % of a stand on the floor.
Collapse collapse(int cells, double tick, double vertical_inertia = 1) {
  constexpr double a = 0.05715, g = 9.81;
  PoolDescription d = channel(cells * 5, a / cells);
  d.viscosity = 1e-6;
  d.damping = 0;
  d.inertia_depth = 1;  // that of the whole column
  d.vertical_inertia = vertical_inertia;
  Basin b(d, tick);
  for (int j = 0; j < d.ny; ++j)
    for (int i = 0; i < cells; ++i) b.fill_to(i, j, 2 * a);
  Collapse out{{{0, 1}}, {{0, 1}}};
  const int ticks = int(3.4 * std::sqrt(a / (2 * g)) / tick);
  for (int t = 1; t <= ticks; ++t) {
    b.tick();
    int i = d.nx - 1;
    while (i > 0 && b.depth(i, 0) < 0.02 * a) --i;
    const double now = t * tick;
    out.front.push_back({now * std::sqrt(2 * g / a), (i + 1) * d.cell / a});
    out.height.push_back({now * std::sqrt(g / a), b.depth(0, 0) / (2 * a)});
  }
  EXPECT_TRUE(balanced(b.ledger));
  EXPECT_EQ(content(b.m, b.s), at(b.ledger, Place::kPool));
  return out;
}

double at_time(const std::vector<Reading>& course, double time) {
  for (std::size_t i = 1; i < course.size(); ++i)
    if (course[i].time >= time) {
      const double share = (time - course[i - 1].time) / (course[i].time - course[i - 1].time);
      return course[i - 1].value + share * (course[i].value - course[i - 1].value);
    }
  return course.back().value;
}

template <std::size_t N>
double worst(const std::vector<Reading>& course, const Reading (&table)[N], const char* what) {
  double most = 0;
  std::printf("%s:", what);
  for (const Reading& r : table) {
    const double off = at_time(course, r.time) / r.value - 1;
    std::printf(" %+.1f%%", 100 * off);
    most = std::max(most, std::fabs(off));
  }
  std::printf("\n");
  return most;
}

TEST(DamBreak, TheFrontRunsAsMartinAndMoyceSaw) {
  const Collapse c = collapse(64, 0.25e-3);
  EXPECT_LT(worst(c.front, kFront, "front, 64 cells"), 0.08);
  EXPECT_LT(worst(c.height, kHeight, "height, 64 cells"), 0.20);
  const Collapse coarse = collapse(32, 0.5e-3);
  EXPECT_LT(worst(coarse.front, kFront, "front, 32 cells"), 0.14);
  worst(coarse.height, kHeight, "height, 32 cells");
}

TEST(DamBreak, PlainShallowWaterWouldRunFarAhead) {
  const Collapse c = collapse(64, 0.125e-3, 0);
  EXPECT_GT(worst(c.front, kFront, "front without vertical inertia"), 0.5);
}

// ---- waves

/// A standing wave of `waves` halves in a channel: its angular frequency and how its amplitude decays [1/s].
struct Wave {
  double omega, decay;
};
Wave standing_wave(double depth, int halves, double damping, double viscosity, int period, int nx = 256) {
  PoolDescription d = channel(nx, 0.00125);
  d.friction = 0;
  d.inertia_depth = 1;
  d.viscosity = viscosity;
  d.damping = damping;
  d.period = period;
  Basin b(d);
  const double k = portable::pi * halves / (nx * d.cell), height = 0.01 * depth;
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < nx; ++i) b.fill_to(i, j, depth + height * std::cos(k * (i + 0.5) * d.cell));
  const auto amplitude = [&] {
    double sum = 0;
    for (int i = 0; i < nx; ++i) sum += b.depth(i, 0) * std::cos(k * (i + 0.5) * d.cell);
    return 2 * sum / nx;
  };
  std::vector<double> crossings, tops;
  double before = amplitude(), top = before;
  for (int t = 1; crossings.size() < 9 && t < 60000; ++t) {
    b.tick();
    const double now = amplitude();
    if (now * before < 0) {
      crossings.push_back((t - 1 + before / (before - now)) * 1e-3);
      tops.push_back(top);
      top = 0;
    }
    top = std::max(top, std::fabs(now));
    before = now;
  }
  EXPECT_EQ(crossings.size(), 9u);
  const double half = (crossings[8] - crossings[0]) / 8;
  return {portable::pi / half, std::log(tops[1] / tops[8]) / (7 * half)};
}

TEST(Ripples, RunWithTheRootOfGravityTimesDepth) {
  for (const double depth : {0.002, 0.005, 0.015})
    for (const int period : {1, 2, 4}) {
      const int nx = 256;
      const double k = portable::pi / (nx * 0.00125);
      const double c = standing_wave(depth, 1, 0, 0, period).omega / k;
      test::expect_within(
          "row 24, speed at " + std::to_string(int(1e3 * depth)) + " mm, step of " + std::to_string(period) + " ms", c,
          std::sqrt(9.81 * depth), 0.01);
    }
}

TEST(Ripples, ShortOnesAreSlowerAsInDeepWater) {
  for (const double kh : {0.5, 1.0, 1.5}) {
    const double k = portable::pi * 10 / (256 * 0.00125), depth = kh / k;
    const double c = standing_wave(depth, 10, 0, 0, 2).omega / k;
    const std::string at = " at kh = " + std::to_string(kh).substr(0, 3);
    test::expect_within("row 24, speed against its own dispersion" + at, c, std::sqrt(9.81 * depth / (1 + kh * kh / 3)),
                        0.01);
    test::expect_within("row 24, speed against Airy's" + at, c, std::sqrt(9.81 / k * std::tanh(kh)), 0.03);
  }
}

TEST(Ripples, FadeWithHalfTheDampingRate) {
  const double depth = 0.005;
  test::expect_within("row 24, decay by damping", standing_wave(depth, 4, 2, 0, 2).decay, 1.0, 0.03);
  const double nu = 3.3e-6, film = 3 * nu / (depth * depth);
  test::expect_within("row 24, decay with the bed's friction", standing_wave(depth, 4, 2, nu, 2).decay,
                      0.5 * (2 + film), 0.03);
  EXPECT_LT(standing_wave(depth, 4, 0, 0, 2).decay, 0.02) << "the scheme itself damps hardly at all";
}

// ---- conservation

PoolDescription square(int n) {
  PoolDescription d;
  d.nx = d.ny = n;
  d.cell = 0.0025;
  return d;
}

TEST(Pool, KeepsEveryPicolitreUnderRainToolsAndAHeavingFloor) {
  Basin b(square(48));
  core::Random r(3);
  const Drain drains[] = {{.i = 5, .j = 40}, {.i = 30, .j = 10, .area = 1e-6}};
  for (int t = 0; t < 4000; ++t) {
    for (std::size_t c = 0; c < b.floor.size(); ++c)
      b.floor[c] = 0.01f * float(std::sin(0.02 * double(c % 48) + 0.003 * t) * std::sin(0.05 * double(c / 48)));
    const int i = int(r.uniform() * 48), j = int(r.uniform() * 48);
    b.fill(i, j, {std::int64_t(r.uniform() * 1e7), std::int64_t(r.uniform() * 1e7), std::int64_t(r.uniform() * 1e6)});
    b.splash(i, j, std::int64_t(r.uniform() * 1e7), {1, -2, -3});
    const float x = float(0.06 + 0.03 * std::sin(0.01 * t));
    const Capsule tool{.a = {x, 0.05f, 0}, .b = {0.1f, 0.05f, 0.2f}, .radius = 0.005f};
    EXPECT_EQ(b.tick({&tool, 1}, drains).flags, 0u);
    const Mix taken = draw_off(b.m, b.floor, {0.03, 0.09, 0.01}, 0.005, std::int64_t(r.uniform() * 3e7), b.s);
    move(b.ledger, Place::kPool, Place::kSucked, taken);
    ASSERT_TRUE(balanced(b.ledger));
    ASSERT_EQ(content(b.m, b.s), at(b.ledger, Place::kPool)) << t;
  }
  for (std::size_t k = 0; k < b.s.blood.size(); ++k)
    ASSERT_TRUE(b.s.blood[k] >= 0 && b.s.saline[k] >= 0 && b.s.bile[k] >= 0);
  EXPECT_GT(at(b.ledger, Place::kPool).total(), kMillilitre);
  EXPECT_GT(at(b.ledger, Place::kDrained).total(), kMillilitre);
  EXPECT_GT(at(b.ledger, Place::kSucked).total(), kMillilitre);
}

TEST(Pool, AtRestOverAnUnevenFloorStaysAtRest) {
  Basin b(square(32));
  for (int j = 0; j < 32; ++j)
    for (int i = 0; i < 32; ++i) {
      const float z = 0.004f * float(std::sin(0.3 * i) + std::cos(0.4 * j));
      b.floor[std::size_t(j) * 32 + i] = z;
      if (z < 0.003f) b.fill_to(i, j, 0.003 - double(z));
    }
  for (int t = 0; t < 1000; ++t) b.tick();
  for (float u : b.s.u) EXPECT_LT(std::fabs(u), 1e-4f);
}

TEST(Pool, FindsItsLevelAndMixes) {
  Basin b(square(32));
  for (int i = 0; i < 32; ++i)
    for (int j = 0; j < 32; ++j) {
      const std::int64_t pl = 40'000'000;
      b.fill(i, j, i < 16 ? Mix{.blood = pl} : Mix{.saline = pl / 2});
    }
  for (int t = 0; t < 20000; ++t) {
    if (t % 400 == 0) b.splash(16, 8 + (t / 400) % 16, 3'000'000, {0, (t / 400) % 2 ? 3.f : -3.f, -2});
    b.tick();
  }
  const double level = 0.75 * 40e6 * 1e-15 / (b.m.cell * b.m.cell);
  for (int t = 0; t < 2000; ++t) b.tick();
  for (int i = 0; i < 32; ++i) EXPECT_NEAR(b.depth(i, 16) / level, 1, 0.01);
  const auto share_at = [&](int i, int j) {
    const Mix own = mix_at(b.m, b.s, i, j);
    return double(own.blood) / double(own.total());
  };
  EXPECT_GT(share_at(24, 16), 0.02) << "blood has gone over";
  EXPECT_LT(share_at(12, 16), 0.999) << "and water the other way";
  EXPECT_EQ(content(b.m, b.s), at(b.ledger, Place::kPool));
}

/// A column of fluid thrown up in a basin: how high the pool ever stands over it from then on, and at last [m].
struct Thrown {
  double highest = 0, at_last = 0, fastest = 0;
};
Thrown thrown_up(double deep, double mound, double radius) {
  Basin b({.nx = 64, .ny = 64});
  const double middle = 32 * b.m.cell;
  for (int j = 0; j < 64; ++j)
    for (int i = 0; i < 64; ++i)
      b.fill_to(i, j,
                deep + (std::hypot((i + 0.5) * b.m.cell - middle, (j + 0.5) * b.m.cell - middle) < radius ? mound : 0));
  const auto top = [&b] {
    double highest = 0;
    for (int j = 0; j < 64; ++j)
      for (int i = 0; i < 64; ++i) highest = std::max(highest, double(depth_at(b.m, b.s, i, j)));
    return highest;
  };
  Thrown t;
  for (int tick = 0; tick < 3000; ++tick) {
    b.tick();
    t.highest = std::max(t.highest, top());
  }
  t.at_last = top();
  for (const auto* speeds : {&b.s.u, &b.s.v})
    for (const float v : *speeds) t.fastest = std::max(t.fastest, double(std::fabs(v)));
  return t;
}

TEST(Pool, WhatIsThrownUpInDeepFluidFallsBackAndSettles) {
  for (const double deep : {0.01, 0.05, 0.15})
    for (const double radius : {0.004, 0.012}) {
      const double mound = 0.036;
      const Thrown t = thrown_up(deep, mound, radius);
      std::printf("    %.0f mm deep, %.0f mm wide: at most %.1f mm, at last %.2f mm, %.4f m/s\n", 1e3 * deep,
                  2e3 * radius, 1e3 * t.highest, 1e3 * t.at_last, t.fastest);
      EXPECT_LT(t.highest, deep + 2 * mound) << "the first step may be too long";
      EXPECT_LT(t.at_last, deep + 0.25 * mound);
      EXPECT_LT(t.fastest, 0.02);
    }
}

TEST(Pool, RisesByWhatAnInstrumentFillsAndRipplesWhenItMoves) {
  Basin b(square(32));
  for (int j = 0; j < 32; ++j)
    for (int i = 0; i < 32; ++i) b.fill_to(i, j, 0.010);
  Capsule tool{.a = {0.02f, 0.04f, 0.005f}, .b = {0.06f, 0.04f, 0.005f}, .radius = 0.0025f};
  for (int t = 0; t < 6000; ++t) b.tick({&tool, 1});
  const double side = 32 * 0.0025, r = 0.0025;
  const double filled = portable::pi * r * r * 0.04 + 4.0 / 3 * portable::pi * r * r * r;
  EXPECT_NEAR((b.depth(2, 2) - 0.010) / (filled / (side * side)), 1, 0.05);
  float fastest = 0;
  for (int t = 0; t < 200; ++t) {
    tool.a.y += 1e-4f, tool.b.y += 1e-4f;
    b.tick({&tool, 1});
  }
  for (float v : b.s.v) fastest = std::max(fastest, std::fabs(v));
  EXPECT_GT(fastest, 0.005f);
  EXPECT_EQ(content(b.m, b.s), at(b.ledger, Place::kPool));
}

TEST(Capsule, ChordIsWhatALineCutsOut) {
  core::Random r(9);
  for (int n = 0; n < 2000; ++n) {
    const auto c = [&] { return float(r.uniform(-1, 1)); };
    Capsule k{.a = {c(), c(), c()}, .b = {c(), c(), c()}, .radius = float(r.uniform(0.1, 0.5))};
    if (n % 3 == 0) k.b.x = k.a.x, k.b.y = k.a.y;
    if (n % 5 == 0) k.b.z = k.a.z;
    const float x = c(), y = c();
    const Interval found = upright_chord(k, x, y);
    double in = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec3f p{x, y, -2 + float(i) * 1e-3f};
      const float s = nearest_share(k, p);
      if (length(p - (k.a + s * (k.b - k.a))) < k.radius) in += 1e-3;
    }
    EXPECT_NEAR(found.empty() ? 0.0 : double(found.high - found.low), in, 5e-3);
  }
}

TEST(Pool, TheInstructionSetChangesNoBit) {
  const PoolKernels* own = &pool_kernels();
  std::vector<std::uint64_t> hashes;
  for (const PoolKernels* set : {pool_kernels_plain(), pool_kernels_avx2(), pool_kernels_avx512()}) {
    if (!use_pool_kernels(set)) continue;
    Basin b(square(37));
    core::Random r(21);
    for (int t = 0; t < 1000; ++t) {
      for (std::size_t c = 0; c < b.floor.size(); ++c)
        b.floor[c] = 0.004f * float(portable::sin(0.3 * double(c % 37) + 0.004 * t));
      b.fill(int(r.uniform() * 37), int(r.uniform() * 37), {.blood = 30'000'000, .saline = 9'000'000, .bile = 77});
      b.splash(int(r.uniform() * 37), int(r.uniform() * 37), 5'000'000, {0.3f, -0.4f, -2});
      const Capsule tool{.a = {0.03f, 0.0005f * float(t % 100), 0}, .b = {0.05f, 0.05f, 0.1f}, .radius = 0.004f};
      b.tick({&tool, 1});
    }
    core::Hasher h;
    add_to_hash(h, b.s);
    hashes.push_back(h.value());
    EXPECT_EQ(h.value(), hashes[0]) << set->name;
  }
  use_pool_kernels(own);
  EXPECT_GE(hashes.size(), 1u);
}

// ---- what nobody should send

TEST(Pool, HostileFloorsToolsAndDrainsAreFlaggedAndHarmless) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  Basin b(square(16));
  for (int j = 0; j < 16; ++j)
    for (int i = 0; i < 16; ++i) b.fill_to(i, j, 0.01);
  b.floor[40] = nan, b.floor[41] = inf, b.floor[42] = -1e30f, b.floor[100] = 1e30f;
  const Capsule tools[] = {{.a = {nan, 0, 0}, .b = {0, 0, 1}, .radius = 0.01f}, {.radius = -1}};
  const Drain drains[] = {{.i = -1}, {.i = 3, .j = 99}, {.i = 1, .j = 1, .area = double(nan)}};
  std::uint32_t flags = 0;
  for (int t = 0; t < 200; ++t) flags |= b.tick(tools, drains).flags;
  EXPECT_TRUE(flags & FluidReport::kBadFloor);
  EXPECT_TRUE(flags & FluidReport::kBadContact);
  EXPECT_TRUE(flags & FluidReport::kBadDrain);
  for (float u : b.s.u) ASSERT_TRUE(std::isfinite(u));
  EXPECT_EQ(content(b.m, b.s), at(b.ledger, Place::kPool));
  const PoolPoint lost = locate(b.m, {double(nan), 0, 0});
  EXPECT_FALSE(lost.inside);
  EXPECT_TRUE(draw_off(b.m, b.floor, {double(nan), 0, 0}, 0.01, 1000, b.s).empty());
}

TEST(Pool, JumpingFloorsDoNotBlowItUp) {
  Basin b(square(24));
  core::Random r(17);
  for (int j = 0; j < 24; ++j)
    for (int i = 0; i < 24; ++i) b.fill_to(i, j, 0.02);
  for (int t = 0; t < 2000; ++t) {
    for (float& z : b.floor) z = float(r.uniform(-0.05, 0.05));
    b.tick();
  }
  for (float u : b.s.u) ASSERT_LE(std::fabs(u), b.m.fastest);
  EXPECT_EQ(content(b.m, b.s), at(b.ledger, Place::kPool));
}

TEST(Pool, MoreThanACellHoldsWaitsAndIsBooked) {
  Basin b(square(8));
  b.fill(3, 3, {.blood = 5'000'000'000});  // 5 mL into a cell of 1.07
  EXPECT_GT(b.s.held.total(), 0);
  EXPECT_EQ(content(b.m, b.s), at(b.ledger, Place::kPool));
  EXPECT_TRUE(b.tick().flags & FluidReport::kPoolHeldBack);
  for (int t = 0; t < 100; ++t) b.tick();
  EXPECT_EQ(b.s.held.total(), 0);
  EXPECT_EQ(content(b.m, b.s), at(b.ledger, Place::kPool));
  b.fill(0, 0, {.blood = 500 * std::int64_t(kMillilitre)});  // more than all cells together
  for (int t = 0; t < 500; ++t) b.tick();
  EXPECT_GT(b.s.held.total(), 0);
  EXPECT_EQ(content(b.m, b.s), at(b.ledger, Place::kPool));
  for (std::size_t k = 0; k < b.s.blood.size(); ++k) ASSERT_GE(b.s.blood[k], 0);
}

}  // namespace
}  // namespace trocar::fluids
