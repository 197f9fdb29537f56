// Jets and drains against Torricelli, and what a jet does to what it hits.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "plates.hpp"
#include "within.hpp"

namespace trocar::fluids {
namespace {

using test::Scene;
using test::small_scene;

constexpr double kArea = 2.0e-6;  // 1.6 mm hole

TEST(Torricelli, AJetLeavesWithTheRootOfTwiceThePressureOverDensity) {
  for (const double pressure : {1.6e3, 9.3e3, 12.4e3}) {
    const double v = torricelli_speed(pressure, 1060);
    EXPECT_NEAR(v, std::sqrt(2 * pressure / 1060), 1e-12);
    Scene b(small_scene());
    b.openings = {test::bleeding({0, 0, 0.1f}, {1, 0, 0}, v * kArea, kArea)};
    for (int t = 0; t < 10 && b.s.droplets.count == 0; ++t) b.tick();
    ASSERT_GT(b.s.droplets.count, 0);
    test::expect_within("row 21, speed of a jet", double(b.s.droplets.vx[0]), v, 0.01);
  }
  EXPECT_NEAR(torricelli_speed(10.8e3, 1060), 4.5, 0.02);  // mean arterial pressure less the cavity's
}

/// Where the drops of a level jet from height h cross z = 0.
double mean_range(double v, double h, double gas) {
  FluidsDescription d = small_scene();
  d.droplets.gas_density = gas;
  d.pool.origin = {-0.08, -0.08, -0.2};
  Scene b(d);
  b.openings = {test::bleeding({0, 0, float(h)}, {1, 0, 0}, v * kArea, kArea)};
  double sum = 0;
  int crossed = 0;
  std::vector<float> before;
  for (int t = 0; t < 600; ++t) {
    before.assign(b.s.droplets.z.begin(), b.s.droplets.z.end());
    const std::vector<float> x = b.s.droplets.x;
    const std::vector<std::uint32_t> id = b.s.droplets.id;
    const int count = b.s.droplets.count;
    b.tick();
    for (int i = 0; i < b.s.droplets.count && i < count; ++i) {
      if (b.s.droplets.id[i] != id[i] || !(before[i] > 0 && b.s.droplets.z[i] <= 0)) continue;
      const double share = double(before[i]) / double(before[i] - b.s.droplets.z[i]);
      sum += double(x[i]) + share * double(b.s.droplets.x[i] - x[i]);
      ++crossed;
    }
  }
  EXPECT_GT(crossed, 20);
  return sum / crossed;
}

TEST(Torricelli, AJetReachesSpeedTimesTheTimeOfItsFall) {
  for (const double v : {0.8, 1.6, 3.2})
    for (const double h : {0.05, 0.1})
      test::expect_within("row 21, range at " + std::to_string(v).substr(0, 3) + " m/s", mean_range(v, h, 0),
                          v * std::sqrt(2 * h / 9.81), 0.01);
}

TEST(Torricelli, CarbonDioxideShortensAJetByAFewPercent) {
  const double free = mean_range(3.2, 0.1, 0), slowed = mean_range(3.2, 0.1, 1.75);
  EXPECT_LT(slowed, 0.998 * free);
  EXPECT_GT(slowed, 0.93 * free);
}

TEST(Torricelli, ATankDrainsInItsTime) {
  // t = (A / a Cd) sqrt(2 / g) (sqrt h1 - sqrt h2), from 40 to 10 mm
  PoolDescription d;
  d.nx = d.ny = 16;
  d.cell = 0.0025;
  d.period = 1;
  const PoolModel m = build(d);
  PoolState s = empty_pool(m);
  PoolWork w = make_work(m);
  Ledger ledger;
  const double h1 = 0.040, h2 = 0.010, area = 0.04 * 0.04, hole = 3e-6;
  for (int j = 0; j < d.ny; ++j)
    for (int i = 0; i < d.nx; ++i) {
      const Mix mix{.saline = std::int64_t(h1 * d.cell * d.cell * kPicolitresPerM3)};
      receive(ledger, Source::kIrrigated, Place::kPool, mix);
      pour(m, i, j, mix, s);
    }
  const Drain drain{.i = 8, .j = 8, .area = hole, .cd = kSharpOrifice};
  const double whole = double(at(ledger, Place::kPool).total());
  int t = 0;
  while (double(at(ledger, Place::kPool).total()) > whole * h2 / h1 && t < 200000) {
    advance(m, {.floor = {}, .capsules = {}, .drains = {&drain, 1}}, s, w, ledger);
    ++t;
  }
  const double wanted = area / (hole * 0.61) * std::sqrt(2 / 9.81) * (std::sqrt(h1) - std::sqrt(h2));
  test::expect_within("row 21, time to drain", t * 1e-3, wanted, 0.01);
  EXPECT_TRUE(balanced(ledger));
  EXPECT_EQ(content(m, s), at(ledger, Place::kPool));
}

TEST(Jet, PushesAPlateWithDensityTimesFlowTimesSpeed) {
  FluidsDescription d = small_scene();
  d.droplets.gas_density = 0;
  d.droplets.gravity = {0, 0, 0};
  d.droplets.capacity = 4000;
  Scene b(d);
  b.plates = {{.centre = {0.03f, 0, 0.05f}, .normal = {-1, 0, 0}, .radius = 0.05f}};
  const double flow = 1.0e-3 / 60, area = 7.07e-6, v = flow / area;  // 1 L/min from a 3 mm nozzle
  b.tools = {{.tip = {0, 0, 0.05f}, .direction = {1, 0, 0}, .irrigation = 1}};
  for (int t = 0; t < 100; ++t) b.tick();
  b.impulse = {0, 0, 0};
  for (int t = 0; t < 400; ++t) {
    const FluidsReport r = b.tick();
    EXPECT_EQ(r.report.flags & FluidReport::kDropletsFull, 0u);
    EXPECT_NEAR(r.tools[0].thrust, 1005 * flow * v, 1e-9);
  }
  test::expect_within("force of a jet on a plate", double(b.impulse.x) / 0.4, 1005 * flow * v, 0.02);
  EXPECT_NEAR(1005 * flow * v, 0.04, 0.001);
}

TEST(Jet, BreaksIntoDropsOfRayleighsSizeAsFarAsTheyAreAllowed) {
  Scene b(small_scene());
  const double hole = 0.5e-6;  // 0.8 mm: drops of 1.5 mm
  b.openings = {test::bleeding({0, 0, 0.1f}, {0, 1, 0}, 1.0 * hole, hole)};
  for (int t = 0; t < 30; ++t) b.tick();
  ASSERT_GT(b.s.droplets.count, 3);
  const double jet = 2 * std::sqrt(hole / std::numbers::pi);
  EXPECT_NEAR(2 * double(b.s.droplets.radius[0]) / (1.89 * jet), 1, 0.01);
}

TEST(Line, FlowsWithTheRootOfPressure) {
  EXPECT_NEAR(line_flow(1e-5, 4, 1, 1), 2e-5, 1e-15);
  EXPECT_NEAR(line_flow(1e-5, 1, 1, 0.25), 0.25e-5, 1e-15);
  EXPECT_EQ(line_flow(1e-5, -1, 1, 1), 0);
}

}  // namespace
}  // namespace trocar::fluids
