// Ten simulated minutes of abuse of the gynaecology scene.
#include <cstdio>

#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>

#include "abuse.hpp"

using namespace trocar;

namespace {

const sim::Model& gynaecology() {
  static const sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/gynaecology/scene.json"));
  return model;
}
const sim::Model& untearable_gynaecology() {
  static const sim::Model model = abuse::untearable(gynaecology());
  return model;
}

constexpr std::uint64_t kTicks = 600'000;
constexpr double kMostEnergy = 5;  // [J] three hands with 10 N each over 10 cm bring 3 J in

void report(const abuse::Round& r, std::uint64_t ticks) {
  const abuse::Left& worst = r.worst();
  std::printf(
      "%6.1f s  %-22s %2d grasps %2d slips %2d exchanges  %5.2f m/s %5.1f N  %6.3f J, left %8.1e J  worst %s "
      "%.2f %% (%.2f mm)%s\n",
      double(ticks) / 1000, r.organ.c_str(), r.grasps, r.slips, r.exchanges, r.most_speed, r.most_force, r.most_energy,
      r.energy_left, worst.name.c_str(), 100 * worst.share, 1000 * worst.distance, r.let_go ? "" : "  NOT LET GO");
  std::fflush(stdout);
}

TEST(AbuseSoak, EveryOrganBearsTenMinutesAndReturnsToItsShape) {
  abuse::Attack attack(untearable_gynaecology(), 1);
  int grasps = 0;
  for (size_t round = 0; attack.ticks() < kTicks; ++round) {
    const abuse::Round r = attack.round(round, 6);
    report(r, attack.ticks());
    grasps += r.grasps;
    SCOPED_TRACE(r.organ + " in round " + std::to_string(round));
    ASSERT_EQ(r.first_bad_tick, 0u) << "flags " << r.flags;
    EXPECT_LT(r.most_energy, kMostEnergy) << "[J]";
    EXPECT_TRUE(r.let_go);
    for (const abuse::Left& left : r.left) EXPECT_LT(left.share, 0.01) << left.name << " " << left.distance << " m";
  }
  EXPECT_GT(grasps, 100) << "hands that never hold anything prove nothing";
}

TEST(AbuseSoak, ScissorsClipsAndTearsEverywhereLeaveNumbersFinite) {
  abuse::Attack attack(gynaecology(), 2, true);
  for (size_t round = 0; attack.ticks() < kTicks / 5; ++round) {
    const abuse::Round r = attack.round(round, 10);
    report(r, attack.ticks());
    SCOPED_TRACE(r.organ + " in round " + std::to_string(round));
    ASSERT_EQ(r.first_bad_tick, 0u) << "flags " << r.flags;
    EXPECT_LT(r.most_energy, kMostEnergy) << "[J]";
  }
}

TEST(AbuseSoak, PedalsValvesAndTheWipeLeaveNumbersFiniteAndTheAccountExact) {
  const sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/bleeding/scene.json"));
  abuse::Attack attack(model, 9, true);
  for (size_t round = 0; attack.ticks() < kTicks / 10; ++round) {
    const abuse::Round r = attack.round(round, 6, 0);
    report(r, attack.ticks());
    SCOPED_TRACE(r.organ + " in round " + std::to_string(round));
    ASSERT_EQ(r.first_bad_tick, 0u) << "flags " << r.flags;
    EXPECT_LT(r.most_energy, kMostEnergy) << "[J]";
    ASSERT_EQ(abuse::broken(model, attack.state()), "");
  }
  EXPECT_EQ(attack.pressed() & 7u, 7u) << "each pedal and the wipe";
  EXPECT_GT(attack.state().flow.bled, 0);
}

/// A liver that hangs on one face swings at 1.8 Hz, and what was torn at keeps an eighth of that after 5 s.
constexpr int kLiversRest = 10'000;

const sim::Model& cutting() {
  static const sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/cutting/scene.json"));
  return model;
}

TEST(AbuseSoak, ALiverThatCanBeCutBearsTwoMinutesAndReturnsToItsShape) {
  const sim::Model model = abuse::untearable(cutting());
  abuse::Attack attack(model, 6);
  int grasps = 0;
  for (size_t round = 0; attack.ticks() < kTicks / 5; ++round) {
    const abuse::Round r = attack.round(0, 6, kLiversRest);
    report(r, attack.ticks());
    grasps += r.grasps;
    ASSERT_EQ(r.first_bad_tick, 0u) << "flags " << r.flags;
    EXPECT_LT(r.most_energy, kMostEnergy) << "[J]";
    EXPECT_TRUE(r.let_go);
    for (const abuse::Left& left : r.left) EXPECT_LT(left.share, 0.005) << left.name << " " << left.distance << " m";
  }
  EXPECT_GT(grasps, 10) << "hands that never hold anything prove nothing";
}

TEST(AbuseSoak, ALiverCutAtRandomForAMinuteStaysFinite) {
  abuse::Attack attack(cutting(), 7, true);
  while (attack.ticks() < kTicks / 10) {
    const abuse::Round r = attack.round(0, 10);
    report(r, attack.ticks());
    ASSERT_EQ(r.first_bad_tick, 0u) << "flags " << r.flags;
    EXPECT_LT(r.most_energy, kMostEnergy) << "[J]";
  }
}

}  // namespace
