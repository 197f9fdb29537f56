// Generator, electrode, sealing: what they do at all. How near that is to measurements: heat_calibration_test.cpp.
#include <gtest/gtest.h>

#include <trocar/tissue/heat/electrosurgery_seal.hpp>
#include <trocar/tissue/heat/heat_look.hpp>

#include "heat_setup.hpp"

namespace trocar::tissue::test {
namespace {

constexpr FootSwitch kBlue{.yellow = false, .blue = true}, kYellow{.yellow = true, .blue = false};

TEST(Generator, AKeyOfItsPanelTurnsASettingByAStepEachTimeItGoesDown) {
  GeneratorPanel p;
  const double before = p.yellow_watts;
  press(kYellowMore, p);
  press(kYellowMore, p);
  EXPECT_EQ(p.yellow_watts, before + kWattStep) << "held down: once";
  press(0, p);
  press(kYellowMore | kBlueLess, p);
  EXPECT_EQ(p.yellow_watts, before + 2 * kWattStep);
  EXPECT_EQ(p.blue_watts, GeneratorPanel{}.blue_watts - kWattStep);
  press(0, p);
  press(kBipolarMore | kBipolarLess | kOtherCut, p);
  EXPECT_EQ(p.bipolar_watts, GeneratorPanel{}.bipolar_watts) << "both at once";
  EXPECT_EQ(p.yellow, EnergyMode::blend);
  for (int i = 0; i < 100; ++i) press(i % 2 ? 0 : kYellowMore | kBlueLess, p);
  EXPECT_EQ(p.yellow_watts, kMostWatts);
  EXPECT_EQ(p.blue_watts, 0);
}

TEST(Generator, GivesItsPowerBetweenTwoLoadsAndLessBeyond) {
  const EnergyCurve c{.low = 100, .high = 1000};
  EXPECT_EQ(load_factor(c, 0), 0);
  EXPECT_DOUBLE_EQ(load_factor(c, 50), 0.5);
  EXPECT_EQ(load_factor(c, 100), 1);
  EXPECT_EQ(load_factor(c, 1000), 1);
  EXPECT_DOUBLE_EQ(load_factor(c, 4000), 0.25);
}

TEST(Generator, PedalsChooseTheMode) {
  const ElectrodeDescription hook, jaws = bipolar_jaws();
  GeneratorPanel panel;
  EXPECT_EQ(asked_mode(hook, panel, kYellow), EnergyMode::cut);
  EXPECT_EQ(asked_mode(hook, panel, kBlue), EnergyMode::coag);
  EXPECT_EQ(asked_mode(hook, panel, {true, true}), EnergyMode::off);
  EXPECT_EQ(asked_mode(hook, panel, {}), EnergyMode::off);
  EXPECT_EQ(asked_mode(jaws, panel, kBlue), EnergyMode::bipolar);
  EXPECT_EQ(asked_mode(jaws, panel, kYellow), EnergyMode::off);
  panel.yellow = EnergyMode::blend;
  EXPECT_EQ(asked_mode(hook, panel, kYellow), EnergyMode::blend);
  panel.blue_watts = 1e9;
  EXPECT_EQ(set_watts(panel, EnergyMode::coag), 120);
  panel.blue_watts = -5;
  EXPECT_EQ(set_watts(panel, EnergyMode::coag), 0);
}

TEST(Electrode, ItsPowerFallsAsTissueDries) {
  for (const bool bipolar : {false, true}) {
    Operated o(HeatDescription{}, half_space());
    if (bipolar) o.e = bipolar_jaws();
    o.panel.blue_watts = o.panel.bipolar_watts = 60;
    const ElectrodeContact c =
        bipolar ? ElectrodeContact{.body = BodyId::strand(0), .a = {0, 0, -0.3e-3}, .b = {0, 0, -2.7e-3}}
                : tip_at(kJustBelow);
    o.press_for(0.104, kBlue, c);
    const double z_wet = o.last.impedance, watts = o.last.tissue;
    o.press_for(bipolar ? 4 : 10, kBlue, c);
    std::printf("    %s: %.0f Ohm and %.1f W in tissue wet, %.0f Ohm and %.1f W dry\n",
                bipolar ? "bipolar, 60 W, 4 s" : "coagulation, 60 W, 10 s", z_wet, watts, o.last.impedance,
                o.last.tissue);
    EXPECT_GT(o.last.impedance, 4 * z_wet);
    EXPECT_LT(o.last.tissue, 0.6 * watts);
    EXPECT_LT(std::fabs(o.imbalance()), 1e-4);
  }
}

TEST(Electrode, SparksCrossAGapOnlyWhenCoagulating) {
  const auto flows = [](FootSwitch pedals, double gap) {
    Operated o(HeatDescription{}, half_space());
    ElectrodeContact c = tip_at(kJustBelow);
    c.gap = gap;
    o.press(pedals, c);
    return o.last.flows;
  };
  EXPECT_TRUE(flows(kBlue, 0));
  EXPECT_TRUE(flows(kBlue, 1e-3));
  EXPECT_FALSE(flows(kBlue, 2e-3));
  EXPECT_TRUE(flows(kYellow, 0));
  EXPECT_FALSE(flows(kYellow, 1e-3));
  EXPECT_FALSE(flows({}, 0));
}

TEST(Electrode, NothingNearMeansNothingFlows) {
  Operated o(HeatDescription{}, half_space());
  o.press_for(1, kBlue, {});
  EXPECT_EQ(o.last.mode, EnergyMode::coag);
  EXPECT_FALSE(o.last.flows);
  EXPECT_EQ(o.s.books.given, 0);
  EXPECT_EQ(bricks_used(o.s), 0);
  EXPECT_EQ(o.es.tip, 37);
  o.press_for(0.1, kBlue, tip_at({0, 0, 0.05}));  // a contact that is no tissue
  EXPECT_EQ(o.s.books.given, 0);
}

TEST(Electrode, WhatItGivesIsWhatTheTissueBooks) {
  Operated o(HeatDescription{}, half_space());
  double current = 0;
  for (int t = 0; t < 4000; ++t) {
    o.press(kBlue, tip_at(kJustBelow));
    current += o.last.tissue * 1e-3;
  }
  EXPECT_NEAR(o.es.joules, current, 1e-6 * current);
  EXPECT_NEAR(o.s.books.given, current, 0.02 * current) << "the tip's own heat is the difference";
  EXPECT_NEAR(o.boiled, o.s.books.steam, 1e-12);
  EXPECT_GT(o.boiled, 1e-6);
}

TEST(Electrode, AHotTipBurnsWithoutCurrent) {
  Operated o(HeatDescription{}, half_space());
  o.press_for(15, kBlue, tip_at(kJustBelow));
  const double tip = o.es.tip;
  const Vec3d fresh{0.02, 0, 0};
  o.press_for(2, {}, tip_at(fresh + kJustBelow));
  std::printf("    a tip of %.0f C makes untouched tissue %.0f C warm in 2 s\n", tip, o.celsius(fresh + kTopCells));
  EXPECT_TRUE(o.last.hot_touch);
  EXPECT_EQ(o.last.output, 0);
  EXPECT_GT(o.celsius(fresh + kTopCells), 45);
  EXPECT_LT(o.es.tip, tip - 5);

  Operated cold(HeatDescription{}, half_space());
  cold.press_for(0.1, {}, tip_at(kJustBelow));
  EXPECT_FALSE(cold.last.hot_touch);
  EXPECT_EQ(bricks_used(cold.s), 0);
}

TEST(Electrode, SticksToCharAndNotToBoilingTissue) {
  Operated o(HeatDescription{}, half_space());
  o.panel.blue_watts = 60;
  double stuck_at = -1, hottest_free = 0;
  for (int t = 0; t < 10000; ++t) {
    o.press(kBlue, tip_at(kJustBelow));
    if (o.es.stuck > 0.05 && stuck_at < 0) stuck_at = 1e-3 * t;
    if (o.es.stuck == 0) hottest_free = std::max(hottest_free, o.celsius(kTopCells));
  }
  std::printf("    60 W on one place stick after %.1f s; before that %.0f C at most\n", stuck_at, hottest_free);
  EXPECT_GT(stuck_at, 1);
  EXPECT_LE(hottest_free, 150.5);
  EXPECT_NEAR(o.last.tear_force, 2, 0.05);
  EXPECT_GT(look(reading(o.m, o.s, BodyId::strand(0), kTopCells)).char_, 0.5f);
  tear_off(o.es);
  o.press_for(0.1, {}, {});
  EXPECT_EQ(o.last.tear_force, 0);
}

TEST(Electrode, OnlyAContinuousWaveParts) {
  for (const FootSwitch pedals : {kYellow, kBlue}) {
    Operated o(HeatDescription{}, half_space());
    o.press_for(1, pedals, tip_at(kJustBelow));
    const HeatReading r = reading(o.m, o.s, BodyId::strand(0), kTopCells);
    EXPECT_GT(r.coagulated, 0.99f);
    EXPECT_EQ(r.parted, pedals.yellow ? 1 : 0);
  }
}

TEST(Electrode, AStateSavedAtAnyTickContinuesWithTheSameBits) {
  Operated o(HeatDescription{}, half_space());
  const auto contact = [](int t) { return tip_at({1e-3 * (t / 700), 0, -0.2e-3}); };
  HeatState heat;
  ElectrodeState electrode;
  for (int t = 0; t < 3000; ++t) {
    if (t == 1234 + 1) heat = o.s, electrode = o.es;
    o.press(t % 900 < 600 ? kBlue : kYellow, contact(t));
  }
  Operated again(HeatDescription{}, half_space());
  again.s = heat, again.es = electrode;
  for (int t = 1235; t < 3000; ++t) again.press(t % 900 < 600 ? kBlue : kYellow, contact(t));
  core::Hasher a, b;
  add_to_hash(a, o.es);
  add_to_hash(b, again.es);
  EXPECT_EQ(a.value(), b.value());
  EXPECT_EQ(o.hash(), again.hash());
}

/// Quality after some seconds at a temperature.
double sealed(const SealDescription& d, SealInput in, double seconds) {
  SealState s;
  for (int t = 0; t < int(seconds * 1000 + 0.5); ++t) seal({}, d, in, 1e-3, s);
  return seal_quality(d, s);
}

TEST(Seal, TakesTemperatureTimeAndPressing) {
  const SealDescription jaws;
  const SealInput artery{.diameter = 2e-3, .compression = 1, .temperature = 80};
  EXPECT_GT(sealed(jaws, artery, 4), 0.85);
  EXPECT_LT(sealed(jaws, artery, 0.3), 0.2) << "too short";
  SealInput cooler = artery, loose = artery;
  cooler.temperature = 60;
  loose.compression = 0;
  EXPECT_LT(sealed(jaws, cooler, 10), 0.05) << "too cool";
  EXPECT_EQ(sealed(jaws, loose, 10), 0) << "not pressed: it stays open";
}

TEST(Seal, HoldsUpToItsCalibre) {
  const SealInput wide{.diameter = 5e-3, .compression = 1, .temperature = 85};
  EXPECT_EQ(sealed({}, wide, 10), 0);
  EXPECT_GT(sealed(sealing_forceps(), wide, 10), 0.95);
  SealInput small = wide;
  small.diameter = 0.8e-3;
  small.compression = 0;
  EXPECT_GT(sealed({}, small, 10), 0.95);
  EXPECT_DOUBLE_EQ(sealing_calibre({}, 0.5), 2e-3);
}

TEST(Seal, CharMakesItBrittleAndAGoodOneHoldsAnArterysPressure) {
  const SealDescription d;
  SealState good, burnt;
  for (int t = 0; t < 4000; ++t) {
    seal({}, d, {.diameter = 2e-3, .compression = 1, .temperature = 85}, 1e-3, good);
    seal({}, d, {.diameter = 2e-3, .compression = 1, .temperature = 250, .char_ = 1}, 1e-3, burnt);
  }
  EXPECT_GT(burst_pressure(d, good), 3 * 16e3);
  EXPECT_LT(burst_pressure(d, burnt), 16e3);
}

}  // namespace
}  // namespace trocar::tissue::test
