// The account: shares of a mix, flows in whole picolitres, and a million things that happen to it.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>

#include "plates.hpp"

namespace trocar::fluids {
namespace {

std::int64_t up_to(core::Random& r, std::int64_t most) { return std::int64_t(r.uniform() * double(most + 1)); }

TEST(Share, IsExactInAllAndNeverMoreThanThereIs) {
  core::Random r(1);
  for (int n = 0; n < 200000; ++n) {
    const std::int64_t size = std::int64_t(1) << (1 + up_to(r, 45));
    const Mix m{up_to(r, size), up_to(r, size), r.uniform() < 0.3 ? 0 : up_to(r, size)};
    const std::int64_t amount = up_to(r, m.total());
    const Mix part = share(m, amount);
    ASSERT_EQ(part.total(), amount);
    for (std::int64_t Mix::*s : {&Mix::blood, &Mix::saline, &Mix::bile}) {
      ASSERT_GE(part.*s, 0);
      ASSERT_LE(part.*s, m.*s);
      const double wanted = double(m.*s) * double(amount) / double(m.total() > 0 ? m.total() : 1);
      ASSERT_NEAR(double(part.*s), wanted, 3 + 1e-15 * wanted);
    }
  }
  EXPECT_TRUE(share({5, 5, 5}, -3).empty());
  EXPECT_EQ(share({5, 6, 7}, 100), (Mix{5, 6, 7}));
}

TEST(WholePicolitres, LoseNothingInTheLongRun) {
  double carry = 0;
  std::int64_t sum = 0;
  const double flow = 1.2345678e-9;  // m^3/s: 1234.5678 pL a tick
  for (int t = 0; t < 1'000'000; ++t) sum += whole_picolitres(flow, 1e-3, carry);
  EXPECT_NEAR(double(sum) + carry, flow * 1e-3 * kPicolitresPerM3 * 1e6, 1);
}

TEST(WholePicolitres, RefuseWhatIsNoFlow) {
  double carry = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(whole_picolitres(-1, 1e-3, carry), 0);
  EXPECT_EQ(whole_picolitres(std::numeric_limits<double>::quiet_NaN(), 1e-3, carry), 0);
  EXPECT_EQ(whole_picolitres(std::numeric_limits<double>::infinity(), 1e-3, carry), kMostAtOnce);
  EXPECT_EQ(carry, 0);
}

TEST(Ledger, SaysWhenAPicolitreIsMissing) {
  Ledger l;
  receive(l, Source::kBled, Place::kDroplets, {.blood = 100});
  move(l, Place::kDroplets, Place::kPool, {.blood = 60});
  EXPECT_TRUE(balanced(l));
  l.at[std::size_t(Place::kPool)].blood -= 1;
  EXPECT_FALSE(balanced(l));
  EXPECT_EQ(imbalance(l), (Mix{.blood = 1}));
  l.at[std::size_t(Place::kDroplets)].blood -= 100;
  l.at[std::size_t(Place::kPool)].blood += 101;
  EXPECT_FALSE(balanced(l)) << "a place holds less than nothing";
}

/// One thing that happens to drops, film or pool without a tick.
void happens(test::Scene& b, core::Random& r) {
  Below below{b.m.pool, b.floor, b.s.pool, b.s.ledger};
  const Mix some{up_to(r, 3'000'000), up_to(r, 3'000'000), up_to(r, 1'000'000)};
  const Vec3f p{float(r.uniform(-0.1, 0.1)), float(r.uniform(-0.1, 0.1)), float(r.uniform(-0.01, 0.05))};
  switch (up_to(r, 6)) {
    case 0:  // a drop is born
      receive(b.s.ledger, Source::kBled, Place::kDroplets, some);
      if (!add_drop(b.m.droplets, p, {0, 0, 0}, some, b.s.droplets))
        detail::put_into_pool(p, some, {}, Place::kDroplets, below);
      break;
    case 1: {  // rain into the pool
      const PoolPoint at = locate(b.m.pool, vec_cast<double>(p));
      receive(b.s.ledger, Source::kIrrigated, Place::kPool, some);
      pour(b.m.pool, at.i, at.j, some, b.s.pool);
      break;
    }
    case 2:  // drops are sucked
      move(b.s.ledger, Place::kDroplets, Place::kSucked,
           draw_drops(b.m.droplets, p, 0.03f, up_to(r, 5'000'000), b.s.droplets));
      break;
    case 3:  // the pool is sucked
      move(b.s.ledger, Place::kPool, Place::kSucked,
           draw_off(b.m.pool, b.floor, vec_cast<double>(p), 0.02, up_to(r, 20'000'000), b.s.pool));
      break;
    case 4: {  // film is wiped off
      move(b.s.ledger, Place::kFilm, Place::kSucked,
           take_film(std::int32_t(up_to(r, 120)) - 10, up_to(r, 9'000'000), b.s.droplets));
      break;
    }
    default: {  // tissue oozes
      Outlet o;
      o.flow = some, o.film = std::int32_t(up_to(r, 99)), o.area = 1e-6;
      const std::uint64_t tick = b.s.droplets.tick;
      plan(b.m.droplets, {&o, 1}, b.s.droplets, b.w.droplets, below);
      b.s.droplets.tick = tick;
      for (int i = 0; i < b.s.droplets.count; ++i) b.s.droplets.vz[i] = 0;
    }
  }
}

TEST(Ledger, IsExactOverAMillionRandomOperations) {
  FluidsDescription d = test::small_scene();
  d.pool.nx = d.pool.ny = 16;
  d.pool.cell = 0.01;
  d.droplets.capacity = 64;
  test::Scene b(d);
  core::Random r(7);
  for (int n = 1; n <= 1'000'000; ++n) {
    happens(b, r);
    ASSERT_TRUE(balanced(b.s.ledger)) << n;
    if (n % 5000 == 0) {
      ASSERT_TRUE(audit(b.m, b.s)) << n;
    }
  }
  EXPECT_GT(b.millilitres(Place::kSucked), 100);
  EXPECT_GT(b.millilitres(Place::kFilm), 1);
}

}  // namespace
}  // namespace trocar::fluids
