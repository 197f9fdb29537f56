// Heat against closed forms: row 26 of the validation table, surface, blood, boiling, damage; and its account.
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include <trocar/numerics/portable.hpp>
#include <trocar/tissue/heat/heat_look.hpp>

#include "heat_setup.hpp"

namespace trocar::tissue::test {
namespace {

double diffusivity(const HeatDescription& d) { return d.conductivity / (d.density * d.heat_capacity); }
/// A point source that has been on for t.
double point_source(const HeatDescription& d, double watts, double r, double t) {
  return watts / (4 * kPi * d.conductivity * r) * std::erfc(r / std::sqrt(4 * diffusivity(d) * t));
}

/// A point source in tissue without end: eight cells around a corner.
Heated point_heated(double cell, int period, double seconds, double watts) {
  HeatDescription d = insulated();
  d.cell = cell;
  d.period = period;
  d.bricks = d.awake = 1024;
  d.wake = 0.002;
  d.sleep = 0.001;
  Heated h(d);
  const HeatSource q{.by_current = 0, .radius = cell, .reach = 1, .watts = watts};
  h.run(seconds, {&q, 1});
  return h;
}
/// Mean over directions that a lattice tells apart.
double rise_at(const Heated& h, double r) {
  const Vec3d ways[] = {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}, normalised(Vec3d{1, 1, 0}), normalised(Vec3d{1, -1, 1})};
  double sum = 0;
  for (const Vec3d& way : ways) sum += h.celsius(r * way) - kBodyHeat;
  return sum / 5;
}

TEST(Heat, APointSourceHeatsAsTheErrorFunctionSays) {
  for (const double cell : {0.5e-3, 0.25e-3}) {
    const Heated h = point_heated(cell, 8, 20, 0.05);
    EXPECT_EQ(h.flags, 0u);
    for (const double r : {1.5e-3, 2e-3, 2.5e-3, 3e-3})
      expect_within("row 26, cells of " + std::to_string(cell * 1e3).substr(0, 4) + " mm, at " +
                        std::to_string(r * 1e3).substr(0, 3) + " mm after 20 s",
                    "f32", rise_at(h, r) / point_source(h.m, 0.05, r, 20) - 1, 0.03);
  }
}

/// Root mean square of what is off within 1 to 3 mm, beside the same of what should be. At corners of cells of 0.72 mm
/// and of all halves of them.
double off_everywhere(const Heated& h, double watts, double t) {
  double off = 0, all = 0;
  for (int i = -4; i <= 4; ++i)
    for (int j = -4; j <= 4; ++j)
      for (int k = -4; k <= 4; ++k) {
        const Vec3d p = 0.72e-3 * Vec3d{double(i), double(j), double(k)};
        const double r = length(p);
        if (r < 1e-3 || r > 3e-3) continue;
        const double wanted = point_source(h.m, watts, r, t), is = h.celsius(p) - kBodyHeat;
        off += (is - wanted) * (is - wanted);
        all += wanted * wanted;
      }
  return std::sqrt(off / all);
}

TEST(Heat, APointSourceConvergesWithTheSquareOfTheCells) {
  std::vector<double> errors;
  for (const double cell : {0.72e-3, 0.36e-3, 0.18e-3})
    errors.push_back(off_everywhere(point_heated(cell, 4, 10, 0.05), 0.05, 10));
  expect_order("row 26, cells halved twice", "f32", errors, 2, 0.35);
}

TEST(Heat, TheAccountOfEnergyCloses) {
  HeatDescription d;
  Heated h(d, half_space());
  HeatSource q{.a = kJustBelow, .b = kJustBelow, .radius = 1e-3, .reach = 2, .watts = 18};
  double worst = 0;
  for (int t = 0; t < 40000; ++t) {
    q.watts = t < 10000 ? 18 : 0;
    q.a.x = q.b.x = 5e-3 * portable::sin(1e-3 * t);
    h.tick({&q, 1});
    if ((t + 1) % 8 == 0) worst = std::max(worst, std::fabs(h.imbalance()));
  }
  expect_within("row 26, account after boiling, blood, gas and sleep", "f32", worst, 1e-5);
  const HeatBooks& b = h.s.books;
  EXPECT_NEAR(b.given, 180, 1e-6);
  EXPECT_GT(b.boiled, 20);
  EXPECT_GT(b.perfused, 1);
  EXPECT_GT(b.surface, 1);
  EXPECT_NEAR(b.steam, h.boiled, 1e-12);
  EXPECT_NEAR(b.boiled, b.steam * (2.257e6 + 4186 * 63), 1e-6 * b.boiled);
  EXPECT_LT(b.conducted + b.dropped, 0.05 * b.given) << "what the edge of the awake bricks takes";
}

TEST(Heat, ACubeCoolsThroughItsFacesAsALumpDoes) {
  HeatDescription d = insulated();
  d.surface = 5;  // so little that the cube is evenly warm: Biot's number is 0.02
  Heated h(d, cube());
  const HeatSource q = all_over(d, 2);
  h.run(0.8, {&q, 1});
  const double side = kBrickSide * d.cell, before = stored(h.m, h.s);
  h.run(60);
  const double tau = h.m.wet_heat() * side / (6 * d.surface);
  expect_within("surface: a cube's heat after 60 s", "f32", stored(h.m, h.s) / (before * std::exp(-60 / tau)) - 1,
                0.01);
  EXPECT_NEAR(h.s.books.surface / (before - stored(h.m, h.s)), 1, 0.01);
}

TEST(Heat, BloodTakesWarmthAwayExponentiallyUntilTissueIsCoagulated) {
  HeatDescription d = insulated();
  d.perfusion = 0.02;
  Heated h(d, cube());
  const HeatSource gentle = all_over(d, 2);
  h.run(0.4, {&gentle, 1});
  const double before = stored(h.m, h.s);
  h.run(30);
  expect_within("perfusion: heat after 30 s", "f32", stored(h.m, h.s) / (before * std::exp(-0.02 * 30)) - 1, 0.005);

  Heated cooked(d, cube());
  const HeatSource strong = all_over(d, 10);
  cooked.run(1.4, {&strong, 1});  // to 95 C
  const double hot = stored(cooked.m, cooked.s);
  cooked.run(30);
  EXPECT_NEAR(stored(cooked.m, cooked.s) / hot, 1, 1e-4);
}

/// Energy per volume that has been given when something first holds [J/mm^3].
template <class Reached>
double energy_until(Heated& h, const HeatSource& q, Reached reached) {
  for (int t = 0; t < 100000 && !reached(); ++t) h.tick({&q, 1});
  return h.s.books.given / (kBrickCells * h.m.cell_volume()) * 1e-9;
}

TEST(Heat, SixtyHundredAndDryTakeTheirEnergies) {
  Heated h(insulated(), cube());
  const HeatSource q = all_over(h.m, 2);
  const Vec3d middle = q.a;
  const double to_60 = energy_until(h, q, [&] { return h.celsius(middle) >= 60; });
  const double to_100 = energy_until(h, q, [&] { return h.celsius(middle) >= 99.9999; });
  const double to_dry = energy_until(h, q, [&] { return reading(h.m, h.s, BodyId::strand(0), middle).water < 1e-4f; });
  expect_within("to 60 C, 0.088 J/mm^3", "f32", to_60 / 0.088 - 1, 0.01);
  expect_within("to 100 C, 0.24 J/mm^3", "f32", to_100 / 0.24 - 1, 0.01);
  expect_within("from there until dry, 1.68 J/mm^3", "f32", (to_dry - to_100) / 1.68 - 1, 0.01);
  expect_within("steam beside 70 % of the mass", "f32", h.boiled / (0.7 * 1060 * kBrickCells * h.m.cell_volume()) - 1,
                1e-4);
}

TEST(Heat, BoilingHoldsAHundredDegreesUntilDry) {
  Heated h(insulated(), cube());
  const HeatSource q = all_over(h.m, 8);
  const Vec3d middle = q.a;
  for (int t = 0; t < 100000 && h.celsius(middle) < 99.9999; ++t) h.tick({&q, 1});
  float water = 1;
  int ticks = 0;
  for (; water > 1e-4f && ticks < 100000; ++ticks) {
    ASSERT_NEAR(h.celsius(middle), 100, 1e-3);
    h.tick({&q, 1});
    const float now = reading(h.m, h.s, BodyId::strand(0), middle).water;
    ASSERT_LE(now, water);
    water = now;
  }
  EXPECT_GT(ticks, 12000);  // 1.68 J/mm^3 in 64 mm^3 at 8 W
  h.run(0.5, {&q, 1});
  EXPECT_GT(h.celsius(middle), 150);  // dry tissue has a third of the capacity and no plateau
}

TEST(Heat, DamageAtAConstantTemperatureIsArrheniusTimesTime) {
  for (const double celsius : {50.0, 55.0, 60.0, 65.0}) {
    HeatDescription d = insulated();
    Heated h(d, cube());
    const HeatSource q = all_over(d, 1e3 * h.m.wet_heat() * kBrickCells * h.m.cell_volume() * (celsius - 37) / 8);
    for (int t = 0; t < 8; ++t) h.tick({&q, 1});
    h.run(0.016);  // taken up
    const double seconds = 10, before = double(h.s.damage[0]);
    EXPECT_NEAR(h.celsius(q.a), celsius, 1e-3);
    h.run(seconds);
    const double wanted = std::exp(std::log(7.4e39) - 257.7e3 / (8.314462618 * (celsius + 273.15))) * seconds;
    expect_within("damage of 10 s at " + std::to_string(int(celsius)) + " C", "f32",
                  (double(h.s.damage[0]) - before) / wanted - 1, 0.005);
    EXPECT_NEAR(double(reading(h.m, h.s, BodyId::strand(0), q.a).coagulated), 1 - std::exp(-double(h.s.damage[0])),
                1e-5);
  }
  EXPECT_EQ(damage_rate({}, 42.9), 0);
}

TEST(Heat, IsStableAtAnyPower) {
  for (const double watts : {1.0, 60.0, 1000.0}) {
    Heated h(HeatDescription{}, half_space());
    const HeatSource q{.a = kJustBelow, .b = kJustBelow, .radius = 0.5e-3, .reach = 1, .watts = watts};
    for (int t = 0; t < 3000; ++t) {
      h.tick({&q, 1});
      if (t % 100 == 0) {
        for (int slot = 0; slot < h.m.awake; ++slot)
          for (int c = 0; c < kBrickCells && h.s.owner[slot] >= 0; ++c) {
            const float u = h.s.u[std::size_t(slot) * kBrickCells + c];
            ASSERT_GE(u, -1e-4f);
            ASSERT_LE(u, 400 - 37 + 1e-2f);
          }
      }
    }
    EXPECT_LT(std::fabs(h.imbalance()), 1e-4) << watts;
  }
}

TEST(Heat, RefusesNonsense) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  Heated h(HeatDescription{}, half_space());
  for (const HeatSource& q : {HeatSource{.a = {nan, 0, 0}, .watts = 1}, HeatSource{.b = {0, inf, 0}, .watts = 1},
                              HeatSource{.radius = nan, .watts = 1}, HeatSource{.watts = nan}, HeatSource{.watts = 1e9},
                              HeatSource{.reach = 1e9, .watts = 1}, HeatSource{.b = {1, 0, 0}, .watts = 1}}) {
    const HeatReport r = advance(h.m, {&q, 1}, h.shape, h.s, h.w);
    EXPECT_EQ(r.flags, std::uint32_t(HeatReport::kBadSource));
    EXPECT_EQ(r.first_bad, 0);
  }
  const HeatSource in_gas{.a = {0, 0, 0.02}, .b = {0, 0, 0.02}, .watts = 1};
  EXPECT_EQ(advance(h.m, {&in_gas, 1}, h.shape, h.s, h.w).flags, std::uint32_t(HeatReport::kMissed));
  EXPECT_EQ(h.s.books.given, 0);
  EXPECT_EQ(reading(h.m, h.s, BodyId::strand(0), {nan, 0, 0}).temperature, 37);
  EXPECT_THROW(build(HeatDescription{.cell = 1e-3}), std::invalid_argument);
  EXPECT_THROW(build(HeatDescription{.cell = 0.1e-3, .period = 64}), std::invalid_argument);
  EXPECT_THROW(build(HeatDescription{.sleep = 2}), std::invalid_argument);
}

TEST(HeatLook, GoesFromPaleOverTanToBlack) {
  const Vec3f pink{0.8f, 0.45f, 0.42f};
  const auto seen = [&](HeatReading r) { return 255.0f * colour(look(r), pink); };
  const auto expect_colour = [](Vec3f c, float r, float g, float b) {
    EXPECT_NEAR(c.x, r, 0.5f);
    EXPECT_NEAR(c.y, g, 0.5f);
    EXPECT_NEAR(c.z, b, 0.5f);
  };
  expect_colour(seen({}), 204, 114.75f, 107.1f);
  expect_colour(seen({.peak = 45}), 204, 114.75f, 107.1f);
  expect_colour(seen({.peak = 60, .coagulated = 1}), 222, 205, 185);
  expect_colour(seen({.peak = 95, .coagulated = 1}), 170, 130, 95);
  expect_colour(seen({.peak = 175, .coagulated = 1, .water = 0}), 60, 40, 25);
  expect_colour(seen({.peak = 220, .coagulated = 1, .water = 0}), 25, 20, 18);
  EXPECT_EQ(look({.temperature = 70}).steam, 0);
  EXPECT_EQ(look({.temperature = 100}).steam, 1);
  EXPECT_EQ(look({.temperature = 100, .water = 0}).steam, 0);
}

TEST(HeatLook, TissueShrinksByATenthToAFifthAndStiffens) {
  EXPECT_EQ(shrinkage({}), 1);
  EXPECT_FLOAT_EQ(shrinkage({.coagulated = 1}), 0.9f);
  EXPECT_FLOAT_EQ(shrinkage({.coagulated = 1, .water = 0}), 0.8f);
  EXPECT_EQ(stiffness({}), 1);
  EXPECT_EQ(stiffness({.coagulated = 1}), 4);
  EXPECT_EQ(stiffness({.coagulated = 1, .water = 0}), 10);
}

}  // namespace
}  // namespace trocar::tissue::test
