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
#include <trocar/numerics/portable.hpp>

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
Collapse collapse(int cells, double tick) {
  constexpr double a = 0.05715, g = 9.81;
  PoolDescription d = channel(cells * 5, a / cells);
  d.viscosity = 1e-6;
  d.damping = 0;
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

}  // namespace
}  // namespace trocar::fluids
