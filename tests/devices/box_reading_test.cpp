// From codes to hands: tables, filter, pedals, and what is said while blocks are missing.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/devices/box/reading.hpp>

namespace trocar::devices {
namespace {

constexpr BoxTime kPeriod = 20'000'000;

BoxPacket packet(unsigned number, std::uint16_t code, std::uint32_t digital = 0, bool checked = true) {
  BoxPacket p;
  p.block.codes.fill(code);
  p.block.digital = digital;
  p.mask = kAllBoxChannels;
  p.checked = checked;
  p.acquired = number * kPeriod;
  p.arrived = p.acquired + 14'000'000;
  return p;
}

TEST(BoxTable, IsLinearBetweenRowsAndGoesOnBeyondThem) {
  const AxisTable table{{100, 200, 400}, {-1, 0, 4}};
  EXPECT_EQ(unfit(table), "");
  EXPECT_DOUBLE_EQ(table.value(150), -0.5);
  EXPECT_DOUBLE_EQ(table.value(300), 2);
  EXPECT_DOUBLE_EQ(table.value(50), -1.5);
  EXPECT_DOUBLE_EQ(table.value(500), 6);
}

TEST(BoxTable, ItsInverseGivesTheCodeBackWhetherItRisesOrFalls) {
  for (const AxisTable& table :
       {AxisTable{{0, 1000, 1500, 4095}, {-2, -1.5, 3, 3.1}}, AxisTable{{10, 20, 4000}, {5, 4.5, -70}}})
    for (double code = 0; code <= kBoxTopCode; code += 13) EXPECT_NEAR(table.code(table.value(code)), code, 1e-9);
}

TEST(BoxTable, WhatIsNotMonotoneIsUnfit) {
  EXPECT_NE(unfit({{1}, {1}}), "");
  EXPECT_NE(unfit({{1, 1}, {1, 2}}), "");
  EXPECT_NE(unfit({{1, 2, 3}, {1, 2, 2}}), "");
  EXPECT_NE(unfit({{1, 2, 3}, {3, 2, 4}}), "");
  EXPECT_NE(unfit({{1, 4096}, {3, 2}}), "");
  EXPECT_NE(unfit({{1, 2}, {3, NAN}}), "");
}

TEST(BoxTable, EightyPerCentOfTheCodesOverAHundredAndTwentyDegreesAreThirteenHundredthsOfAMillimetre) {
  const AxisTable& yaw = default_wiring().axis(BoxActor::left, BoxAxis::yaw).table;
  const double step = yaw.value(2001) - yaw.value(2000);
  EXPECT_NEAR(step * 180 / 3.14159265, 0.0366, 1e-4);
  EXPECT_NEAR(step * 0.2, 0.13e-3, 0.005e-3) << "at a tip 200 mm away";
  EXPECT_EQ(channels_in(default_wiring().mask()), 25);
}

TEST(BoxFilter, StandingNoiseIsHalvedAndAHandAtWorkIsFollowedWithinTenMilliseconds) {
  OneEuro rest;
  double squares = 0;
  for (int i = 0; i < 4000; ++i) {
    const double noise = i * 7919 % 13 - 6.0;  // evenly from -6 to 6, in no order: rms 3.74
    const double value = rest.next(1e-4 * noise, 0.02, 5, 40);
    if (i > 100) squares += value * value;
  }
  EXPECT_LT(std::sqrt(squares / 3900), 0.6 * 3.74e-4);
  OneEuro moving;
  double value = 0;
  for (int i = 0; i < 200; ++i) value = moving.next(0.5 * 0.02 * i, 0.02, 5, 40);  // 0.5 rad/s
  EXPECT_LT((0.5 * 0.02 * 199 - value) / 0.5, 0.010);
  EXPECT_GT((0.5 * 0.02 * 199 - value) / 0.5, 0.002);
}

TEST(BoxPedals, AChangeCountsAtOnceAndBouncesDoNot) {
  Debounce debounce;
  debounce.next(0, 0, true);
  EXPECT_EQ(debounce.next(1, 10'000'000, true), 1u);
  EXPECT_EQ(debounce.next(0, 11'000'000, true), 1u);
  EXPECT_EQ(debounce.next(1, 12'000'000, true), 1u);
  EXPECT_EQ(debounce.next(0, 16'000'000, true), 0u) << "5 ms later it is another change";
  EXPECT_EQ(debounce.next(3, 40'000'000, true), 3u) << "every bit for itself";
}

TEST(BoxPedals, WithoutAChecksumASingleBlockPressesNothing) {
  Debounce debounce;
  debounce.next(0, 0, false);
  EXPECT_EQ(debounce.next(1, kPeriod, false), 0u);
  EXPECT_EQ(debounce.next(0, 2 * kPeriod, false), 0u);
  EXPECT_EQ(debounce.next(1, 3 * kPeriod, false), 0u);
  EXPECT_EQ(debounce.next(1, 4 * kPeriod, false), 1u);
}

TEST(BoxReader, EveryPressOfAHandsButtonIsOneChangeOfItsInstrument) {
  BoxReader reader(default_wiring());
  const std::uint32_t button = 1u << 8;
  unsigned n = 0;
  reader.read(packet(n++, 2000, button));  // down from the beginning
  EXPECT_EQ(reader.read(packet(n++, 2000, button)).changes[0], 0u);
  for (int press = 0; press < 3; ++press) {
    reader.read(packet(n++, 2000, 0));
    reader.read(packet(n++, 2000, button));
    reader.read(packet(n++, 2000, button));
  }
  EXPECT_EQ(reader.read(packet(n++, 2000, 0)).changes[0], 3u);
  EXPECT_EQ(reader.read(packet(n++, 2000, 0)).changes[1], 0u);
}

TEST(BoxReader, ReadsPedalsValvesAndAxesWhereTheyAreWired) {
  BoxWiring wiring = default_wiring();
  wiring.filter.rest = 0;
  wiring.inverted = 1;  // coagulation opens its contact
  wiring.axes[2][0].channel = -1;
  BoxReader reader(wiring);
  const BoxPose& pose = reader.read(packet(1, 3686, 1u | 2u | 1u << 9 | 1u << 13));
  EXPECT_EQ(pose.pedals, std::uint32_t(kBoxCut));
  EXPECT_EQ(pose.valves[0], 1);
  EXPECT_EQ(pose.valves[1], 2);
  EXPECT_NEAR(pose.of(BoxActor::left, BoxAxis::depth), 0.3, 1e-12);
  EXPECT_NEAR(pose.of(BoxActor::left, BoxAxis::pitch), 1.0471975512, 1e-9);
  EXPECT_FALSE(pose.has(BoxActor::third, BoxAxis::yaw));
  EXPECT_TRUE(pose.has(BoxActor::third, BoxAxis::pitch));
}

TEST(BoxReader, TheLightPostGoesOnOverTheEndOfItsChannel) {
  BoxWiring wiring = default_wiring();
  wiring.filter.rest = 0;
  BoxReader reader(wiring);
  const double first = reader.read(packet(1, 3600)).of(BoxActor::scope, BoxAxis::handle);
  const double next = reader.read(packet(2, 460)).of(BoxActor::scope, BoxAxis::handle);
  EXPECT_GT(next, first);
  EXPECT_LT(next - first, 0.3);
  EXPECT_LT(reader.read(packet(3, 3600)).of(BoxActor::scope, BoxAxis::handle), next);
}

BoxPose moving(unsigned number) {
  BoxPose pose;
  pose.axes[0][0] = 0.01 * number;  // 0.5 rad/s
  pose.pedals = kBoxCoagulate;
  pose.acquired = number * kPeriod;
  pose.arrived = pose.acquired + 14'000'000;
  pose.number = number;
  return pose;
}

TEST(BoxBridge, GoesOnForFortyMillisecondsThenHoldsThenFreezesAndLetsThePedalGo) {
  BoxBridge bridge(kPeriod);
  EXPECT_EQ(bridge.at(0).pedals, 0u);
  EXPECT_EQ(bridge.freshness(), BoxFreshness::frozen) << "nothing has come yet";
  bridge.take(moving(1));
  bridge.take(moving(2));
  const BoxTime missing = moving(2).arrived + kPeriod * 3 / 2;
  EXPECT_DOUBLE_EQ(bridge.at(missing - 1).axes[0][0], 0.02);
  EXPECT_EQ(bridge.freshness(), BoxFreshness::measured);
  EXPECT_NEAR(bridge.at(missing + 20'000'000).axes[0][0], 0.03, 1e-9);
  EXPECT_EQ(bridge.freshness(), BoxFreshness::extrapolated);
  EXPECT_NEAR(bridge.at(missing + 45'000'000).axes[0][0], 0.04, 1e-9);
  EXPECT_EQ(bridge.freshness(), BoxFreshness::held);
  EXPECT_EQ(bridge.at(missing + 45'000'000).pedals, std::uint32_t(kBoxCoagulate));
  EXPECT_NEAR(bridge.at(missing + 60'000'000).axes[0][0], 0.04, 1e-9);
  EXPECT_EQ(bridge.freshness(), BoxFreshness::frozen);
  EXPECT_EQ(bridge.at(missing + 60'000'000).pedals, 0u);
  bridge.take(moving(9));
  EXPECT_DOUBLE_EQ(bridge.at(moving(9).arrived).axes[0][0], 0.09);
  EXPECT_EQ(bridge.freshness(), BoxFreshness::measured);
}

TEST(BoxBridge, WhatAHandCannotDoIsNotExtrapolated) {
  BoxBridge bridge(kPeriod);
  BoxPose far = moving(2);
  far.axes[0][3] = 1e6;
  bridge.take(moving(1));
  bridge.take(far);
  EXPECT_LT(bridge.at(far.arrived + kPeriod * 3).axes[0][3], 1e6 + 0.1);
}

}  // namespace
}  // namespace trocar::devices
