// How the pressure in the abdomen follows what is sucked.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/tick.hpp>
#include <trocar/fluids/insufflator.hpp>

using namespace trocar::fluids;

namespace {

using trocar::core::kTick;
constexpr double kLitrePerMinute = 1e-3 / 60, kPascalPerMmHg = 133.322;

double pressure_after(double seconds, double sucked) {
  const Insufflator i;
  CavityGas gas = full(i);
  for (int t = 0; t < int(seconds / kTick); ++t) advance(i, sucked, kTick, gas);
  return gas.pressure / kPascalPerMmHg;
}

TEST(Insufflator, KeepsItsPressureToTheBitWhileNobodySucks) {
  EXPECT_EQ(pressure_after(10, 0), full({}).pressure / kPascalPerMmHg);
}

TEST(Insufflator, HoldsAgainstWhatItCanReplaceAsFarBelowAsTheShareOfItsFlow) {
  EXPECT_NEAR(pressure_after(60, 10 * kLitrePerMinute), 12 - 3 * 10.0 / 20, 1e-3) << "half of what it gives";
}

TEST(Insufflator, LosesTheAbdomenToWhoSucksMore) {
  // Three mmHg are gone while it comes to give all; then 5 L/min are missing, 0.3 L/mmHg.
  const double at_10 = pressure_after(10, 25 * kLitrePerMinute), at_30 = pressure_after(30, 25 * kLitrePerMinute);
  EXPECT_LT(at_10, 9);
  EXPECT_NEAR(at_10 - at_30, 20 * 5.0 / 60 / 0.3, 0.01) << "[mmHg]";
  EXPECT_EQ(pressure_after(120, 25 * kLitrePerMinute), 0);
}

TEST(Insufflator, FillsItAgain) {
  const Insufflator i;
  CavityGas gas{.pressure = 0, .flow = 0};
  int ticks = 0;
  for (; gas.pressure < 9 * kPascalPerMmHg; ++ticks) advance(i, 0, kTick, gas);
  EXPECT_NEAR(ticks * kTick, 9 * 0.3 / 20 * 60, 0.01) << "[s], at its full flow";
}

}  // namespace
