// A syringe: what a flow takes, what a thumb feels, and that a cavity's opening bounds it.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/interactions/instrument/syringe.hpp>
#include <trocar/numerics/portable.hpp>

using namespace trocar;
using namespace trocar::interactions;

namespace {

constexpr double kPerMinute = 1e-6 / 60;  // mL/min
constexpr double kOpens = 25e3;           // [Pa] of a uterus

NeedleModel needle_22g() {
  NeedleModel n;
  n.there = true;
  return n;
}

}  // namespace

TEST(Syringe, ANeedleOf22GaugeLosesThreePointFourKilopascalsAtTenMillilitresAMinute) {  // [Poiseuille]
  const NeedleModel n = needle_22g();
  const double law = 128 * 0.7e-3 * 0.020 / (portable::pi * std::pow(0.41e-3, 4));
  EXPECT_NEAR(n.resistance(kInjected) / law, 1, 0.01);
  EXPECT_NEAR(n.resistance(kInjected) * 10 * kPerMinute, 3.4e3, 0.05e3);
  EXPECT_NEAR(n.resistance(kInjected) * 30 * kPerMinute, 10e3, 0.15e3);
  // Into the open all of the pressure is lost in the needle.
  for (const double q : {1.0, 10.0, 30.0}) {
    const PlungerPush p = push_plunger(n, {}, q * kPerMinute);
    EXPECT_EQ(p.flow, q * kPerMinute);
    EXPECT_NEAR(p.force / (law * q * kPerMinute * n.area()), 1, 0.01);
  }
}

TEST(Syringe, TheThumbFeelsThePressureOnThePlungersArea) {  // [plunger]
  const NeedleModel n = needle_22g();
  EXPECT_NEAR(n.area(), 0.25 * portable::pi * 0.0145 * 0.0145, 1e-12);
  for (const double q : {0.2, 1.0, 5.0, 10.0, 60.0}) {
    const PlungerPush p = push_plunger(n, {2e3, kOpens}, q * kPerMinute);
    EXPECT_NEAR(p.force, (p.tip + n.resistance(kInjected) * p.flow) * n.area(), 1e-12) << q;
  }
}

TEST(Syringe, ACavityOpensAtItsPressureAndNoHigherOneIsNeeded) {
  const NeedleModel n = needle_22g();
  const PlungerPush fast = push_plunger(n, {0, kOpens}, 10 * kPerMinute);
  EXPECT_EQ(fast.tip, kOpens);
  EXPECT_EQ(fast.flow, 10 * kPerMinute);
  EXPECT_NEAR(fast.force, (25e3 + 3.4e3) * n.area(), 0.02);  // 4.7 N
}

TEST(Syringe, BelowThatPressureFluidSeepsAwaySlowly) {
  const NeedleModel n = needle_22g();
  const PlungerPush slow = push_plunger(n, {0, kOpens}, 0.5 * kPerMinute);
  EXPECT_EQ(slow.flow, 0.5 * kPerMinute);
  EXPECT_NEAR(slow.tip, 0.5 * kOpens, 1);
  NeedleModel weak = n;
  weak.most_force = 0.5 * kOpens * n.area();
  const PlungerPush held = push_plunger(weak, {0, kOpens}, 10 * kPerMinute);
  EXPECT_LT(held.flow, 0.5 * kPerMinute);
  EXPECT_GT(held.flow, 0.4 * kPerMinute);
  EXPECT_LE(held.force, weak.most_force * (1 + 1e-12));
}

/// Tissue that is full takes nothing: what the hand wants comes back along the needle, with the pressure that this
/// takes.
TEST(Syringe, WhereTissueFillsPressureRisesAndFluidComesBackAlongTheNeedle) {  // [back flow]
  const NeedleModel n = needle_22g();
  const double gapes = 4e-11, wanted = 10 * kPerMinute;
  double last_tip = 0, last_in = 1;
  for (const double fills : {0.0, 1e10, 1e11, 1e12, 1e15}) {
    const PlungerPush p = push_plunger(n, {0, kOpens, fills, gapes}, wanted);
    const double in = p.flow - p.back, beyond = p.tip - kOpens;
    EXPECT_EQ(p.flow, wanted) << "the thumb is strong enough";
    EXPECT_NEAR(p.back, gapes * beyond, 1e-9 * wanted) << fills;
    EXPECT_NEAR(in * fills, beyond, 1e-6 * kOpens) << fills;
    EXPECT_GE(p.tip, last_tip);
    EXPECT_LT(in, last_in);
    last_tip = p.tip, last_in = in;
  }
  EXPECT_NEAR(last_tip, kOpens + wanted / gapes, 5);
  EXPECT_LT(last_in, 1e-3 * wanted);
}

TEST(Syringe, AgainstFullTissueAThumbIsTooWeakForAnyFlow) {  // [back flow]
  const NeedleModel n = needle_22g();
  const PlungerPush p = push_plunger(n, {0, kOpens, 1e15, 4e-11}, 600 * kPerMinute);
  EXPECT_LT(p.flow, 500 * kPerMinute);
  EXPECT_NEAR(p.force, n.most_force, 1e-9);
}

TEST(Syringe, AThumbExceedsItsForceNever) {
  NeedleModel n = needle_22g();
  for (const double most : {0.5, 2.0, 5.0, 40.0})
    for (const double q : {0.1, 1.0, 10.0, 100.0})
      for (const double pressure : {0.0, 10e3, 60e3}) {
        n.most_force = most;
        const PlungerPush p = push_plunger(n, {pressure, kOpens}, q * kPerMinute);
        EXPECT_GE(p.flow, 0);
        EXPECT_LE(p.flow, q * kPerMinute);
        EXPECT_LE(p.force, most * (1 + 1e-12));
      }
}
