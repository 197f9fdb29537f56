// Fluids in display keyframes: what comes back is what is drawn, whatever the bytes.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/fluids/shown_fluids.hpp>

namespace trocar::fluids {
namespace {

FluidsModel small_model() {
  FluidsDescription d;
  d.pool.nx = d.pool.ny = 32;
  d.pool.origin = {-0.02, -0.02, 0};
  d.droplets.capacity = 500;
  d.droplets.film_cells = 400;
  d.smoke.nx = d.smoke.ny = d.smoke.nz = 6;
  return build(d);
}

/// Some of everything: drops that fly and one that lies on a slope, film, a puddle of two kinds, smoke, a fogged lens.
FluidsState busy(const FluidsModel& m) {
  FluidsState s = initial_state(m);
  DropletState& d = s.droplets;
  for (int k = 0; k < 40; ++k)
    add_drop(m.droplets, {0.001f * float(k), 0.0123f, 0.03f}, {0.5f, 0.1f, -1.2f}, {.blood = 300'000 + 7'777 * k}, d);
  d.body[3] = 2;
  d.ground[3] = {{0.6f, 0, 0.8f}, 0.6f * d.x[3] + 0.8f * d.z[3] - 0.0007f, {0.02f, 0, 0}, 17};
  for (std::size_t i = 0; i < d.film.size(); i += 7) d.film[i] = {std::int32_t(1'000 * i), 40'000, 0};
  for (int j = 4; j < 20; ++j)
    for (int i = 6; i < 25; ++i) pour(m.pool, i, j, {.blood = 700'300, .saline = 90'000 * j}, s.pool);
  for (int k = 0; k < 20; ++k) boil(m.smoke, {0, 0.004 * k - 0.03, 0.02}, 1e-9 * k, s.smoke);
  s.smoke.fog = 0.42;
  s.smoke.wipe_left = 5.5;
  return s;
}

std::vector<std::uint8_t> bytes_of(const FluidsModel& m, const FluidsState& s) {
  std::vector<std::uint8_t> out;
  put_shown(m, s, out);
  return out;
}

TEST(ShownFluids, ComeBackAsTheyAreDrawn) {
  const FluidsModel m = small_model();
  const FluidsState from = busy(m);
  FluidsState to = initial_state(m);
  const std::vector<std::uint8_t> bytes = bytes_of(m, from);
  ASSERT_EQ(take_shown(m, bytes, to), std::ptrdiff_t(bytes.size()));
  EXPECT_EQ(to.smoke.fog, 0.42);
  EXPECT_EQ(to.smoke.wipe_left, 5.5);
  ASSERT_EQ(to.droplets.count, from.droplets.count);
  for (std::size_t k = 0; k < std::size_t(to.droplets.count); ++k) {
    const DropletState &a = from.droplets, &b = to.droplets;
    EXPECT_LT(length(Vec3f{a.x[k] - b.x[k], a.y[k] - b.y[k], a.z[k] - b.z[k]}), 5e-5f) << k;
    const Vec3f still = a.body[k] >= 0 ? a.ground[k].velocity : Vec3f{};
    EXPECT_NEAR(a.vz[k] - still.z, b.vz[k], 0.011f) << k;
    EXPECT_NEAR(a.vx[k] - still.x, b.vx[k], 0.011f) << k;
    EXPECT_NEAR(a.radius[k], b.radius[k], 0.01f * a.radius[k]) << k;
    EXPECT_EQ(a.body[k], b.body[k]);
    EXPECT_EQ(a.id[k], b.id[k]);
  }
  const Ground &on = from.droplets.ground[3], &shown = to.droplets.ground[3];
  EXPECT_EQ(length(on.normal - shown.normal), 0);
  EXPECT_NEAR(on.offset, shown.offset, 1e-4f);
  for (int j = 0; j < 32; ++j)
    for (int i = 0; i < 32; ++i)
      EXPECT_NEAR(depth_at(m.pool, from.pool, i, j), depth_at(m.pool, to.pool, i, j), 1.5e-6f) << i << ' ' << j;
  for (std::size_t i = 0; i < from.droplets.film.size(); ++i)
    EXPECT_NEAR(double(from.droplets.film[i].total()), double(to.droplets.film[i].total()), 1000) << i;
  for (std::size_t c = 0; c < from.smoke.density.size(); ++c) {
    const float d = from.smoke.density[c];
    ASSERT_LT(d, 900);
    EXPECT_NEAR(d, to.smoke.density[c], 0.14f * std::sqrt(d) + 0.005f) << c;
  }
}

TEST(ShownFluids, StoredAgainAreTheSameAndReplaceWhatWasThere) {
  const FluidsModel m = small_model();
  FluidsState to = initial_state(m), wet = busy(m);
  const std::vector<std::uint8_t> bytes = bytes_of(m, busy(m)), dry = bytes_of(m, initial_state(m));
  ASSERT_GT(take_shown(m, bytes, to), 0);
  EXPECT_EQ(bytes_of(m, to), bytes);
  ASSERT_GT(take_shown(m, dry, wet), 0);
  EXPECT_EQ(bytes_of(m, wet), dry);
  EXPECT_LT(dry.size(), 32u) << "a dry scene takes next to nothing";
}

TEST(ShownFluids, HostileBytesAreRefusedOrSound) {
  const FluidsModel m = small_model();
  const std::vector<std::uint8_t> good = bytes_of(m, busy(m));
  FluidsState s = initial_state(m);
  core::Random random(11);
  int taken = 0;
  for (int round = 0; round < 4000; ++round) {
    std::vector<std::uint8_t> bytes = good;
    for (int k = 0; k < 1 + round % 4; ++k)
      bytes[std::size_t(random.uniform() * double(bytes.size()))] = std::uint8_t(random.uniform() * 256);
    if (round % 5 == 0) bytes.resize(std::size_t(random.uniform() * double(bytes.size())));
    const std::ptrdiff_t read = take_shown(m, bytes, s);
    ASSERT_LE(read, std::ptrdiff_t(bytes.size()));
    if (read < 0) continue;
    ++taken;
    ASSERT_TRUE(s.droplets.count >= 0 && s.droplets.count <= m.droplets.capacity);
    for (std::size_t k = 0; k < std::size_t(s.droplets.count); ++k) {
      ASSERT_TRUE(std::isfinite(s.droplets.x[k] + s.droplets.y[k] + s.droplets.z[k] + s.droplets.ground[k].offset));
      ASSERT_GT(s.droplets.radius[k], 0);
    }
    for (const float d : s.smoke.density) ASSERT_TRUE(d >= 0 && d < 1e4f);
    for (const SmallMix& f : s.droplets.film) ASSERT_TRUE(f.blood >= 0 && f.saline >= 0 && f.bile >= 0);
    const std::vector<std::uint8_t> again = bytes_of(m, s);
    ASSERT_GT(take_shown(m, again, s), 0);
    ASSERT_EQ(bytes_of(m, s), again);
  }
  EXPECT_GT(taken, 100);
  EXPECT_LT(taken, 4000);
}

}  // namespace
}  // namespace trocar::fluids
