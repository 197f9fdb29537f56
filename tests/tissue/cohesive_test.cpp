// The cohesive law: what parting costs, and that nothing heals.
#include <gtest/gtest.h>

#include <trocar/tissue/failure/cohesive.hpp>

using namespace trocar::tissue;

namespace {

constexpr double kTick = 1e-3;

/// Opened at a steady speed [m/s] until nothing holds. @return the work of the traction [J/m^2]
double work_to_open(const CohesiveLaw& law, double speed) {
  double damage = 0, work = 0;
  for (double opening = 0; damage < 1; opening += speed * kTick) {
    damage = damage_after(law, damage, opening, kTick);
    work += (1 - damage) * law.stiffness() * opening * speed * kTick;
  }
  return work;
}

}  // namespace

TEST(Cohesive, PartingASquareMetreSlowlyTakesItsToughness) {
  for (const double toughness : {50.0, 120.0, 164.0})
    for (const double opens : {0.002, 0.005}) {
      const CohesiveLaw law = CohesiveLaw::of(toughness, opens);
      EXPECT_NEAR(law.toughness(), toughness, 1e-9 * toughness);
      EXPECT_NEAR(work_to_open(law, 0.001), toughness, 0.01 * toughness);
    }
}

TEST(Cohesive, ItDoesNotDependOnTheSpeedUntilDamageLagsBehind) {
  const CohesiveLaw law = CohesiveLaw::of(50, 0.005);
  const double slow = work_to_open(law, 0.0005);
  EXPECT_NEAR(work_to_open(law, 0.02), slow, 0.02 * slow);
  EXPECT_GT(work_to_open(law, 0.1), 1.5 * slow) << "a jerk is borne for a fifth of a second";
}

TEST(Cohesive, WhatHasBeenOpenedHoldsLessAndNeverHeals) {
  const CohesiveLaw law = CohesiveLaw::of(50, 0.005);
  double damage = 0;
  for (int tick = 0; tick < 1000; ++tick) damage = damage_after(law, damage, 0.002, kTick);
  EXPECT_NEAR(damage, damage_at(law, 0.002), 1e-12);
  EXPECT_GT(damage, 0.5);
  EXPECT_LT(damage, 1);
  for (const double opening : {0.0, 0.0005, 0.0019}) EXPECT_EQ(damage_after(law, damage, opening, kTick), damage);
}

TEST(Cohesive, TractionIsContinuousAndFallsInAStraightLine) {
  const CohesiveLaw law = CohesiveLaw::of(50, 0.005);
  const auto traction = [&](double opening) { return (1 - damage_at(law, opening)) * law.stiffness() * opening; };
  EXPECT_NEAR(traction(law.yields), law.peak, 1e-9 * law.peak);
  EXPECT_NEAR(traction(0.5 * (law.yields + law.opens)), 0.5 * law.peak, 1e-9 * law.peak);
  EXPECT_NEAR(traction(law.opens - 1e-9), 0, 1e-5 * law.peak);
}

TEST(Cohesive, WhatWasSpentIsTheAreaBelowTheCurveThatDoesNotComeBack) {
  const CohesiveLaw law = CohesiveLaw::of(50, 0.005);
  EXPECT_EQ(spent(law, 0), 0);
  EXPECT_NEAR(spent(law, 1), 50, 1e-9);
  for (const double opening : {0.0015, 0.003, 0.0045}) {
    double work = 0;
    constexpr int kParts = 100000;
    for (int i = 0; i < kParts; ++i) {
      const double at = opening * (i + 0.5) / kParts;
      work += (1 - damage_at(law, at)) * law.stiffness() * at * opening / kParts;
    }
    const double damage = damage_at(law, opening);
    EXPECT_NEAR(spent(law, damage), work - 0.5 * (1 - damage) * law.stiffness() * opening * opening, 1e-5);
  }
}
