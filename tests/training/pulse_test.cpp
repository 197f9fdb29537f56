// What a hand feels of the pulse as a fact, and the count of its beats.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/training/exercise/monitor.hpp>
#include <trocar/training/expert/expert.hpp>
#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

const Exercise& palpation() {
  static const Exercise e = read_exercise(TROCAR_SOURCE_DIR "/scenes/basics/pulse-palpation.json");
  return e;
}
const sim::Model& cushions() {
  static const sim::Model m = scene::compile(scene::read_scene(palpation().scene));
  return m;
}

std::unique_ptr<Observer> watch(const char* fact, std::vector<std::int32_t> arguments) {
  const Fact* known = find_fact(fact);
  EXPECT_NE(known, nullptr);
  Arguments a;
  for (const std::int32_t i : arguments) {
    Argument one;
    one.given = i >= 0;
    one.index = i;
    a.push_back(one);
  }
  return known->watch(cushions(), a);
}

/// Declares every `apart` seconds, as often as that.
double off_after(double apart, int taps) {
  sim::State state = sim::initial_state(cushions());
  const std::unique_ptr<Observer> off = watch("pulse.tapped_off_per_min", {});
  for (int i = 0; i < taps; ++i) {
    const std::uint64_t at = std::uint64_t(1000 + std::lround(1000 * apart * i));
    state.declaring = 1;
    state.tick = at;
    off->happened({cushions(), state});
    state.declaring = 0;
    state.tick = at + 100;
    off->sample({cushions(), state}, 0.02);
  }
  const Value v = off->value({cushions(), state});
  return v.known ? 60 * v.number : std::nan("");
}

TEST(PulseFacts, TheTappedRateIsKnownFromTheSixthDeclarationOnAndAPauseBeginsAnew) {
  EXPECT_TRUE(std::isnan(off_after(60.0 / 72, 5)));
  EXPECT_NEAR(off_after(60.0 / 72, 6), 0, 0.2);
  EXPECT_NEAR(off_after(60.0 / 80, 9), 8, 0.2);
  EXPECT_NEAR(off_after(60.0 / 50, 6), -22, 0.2);
  EXPECT_TRUE(std::isnan(off_after(3, 9)));
}

// The demonstration as far as the first artery: it is felt where it is pressed on, and nowhere else.
TEST(PulseFacts, AHandFeelsTheArteryThatItPressesOnAndNoOther) {
  const sim::Model& model = cushions();
  sim::State state = sim::initial_state(model);
  sim::Work work = sim::make_work(model);
  const int one = model.vessel_index("artery_one"), two = model.vessel_index("artery_two");
  const int right = model.hand_index("right"), left = model.hand_index("left");
  const auto felt = [&](int hand, int vessel) {
    return watch("hand.pulse_N", {hand, vessel})->value({model, state}).number;
  };
  EXPECT_EQ(felt(right, one), 0);
  const std::unique_ptr<Expert> expert = make_expert(palpation(), model, {}, 0);
  double least = 1e9, most = 0;
  while (state.tick < 7000) {
    expert->after(model, state, sim::step(model, expert->next(model, state), state, work));
    if (state.tick < 5500) continue;
    const interactions::ToolState& tool = state.tools[size_t(right)];
    const double force = length(Vec3d{tool.contact_force[0], tool.contact_force[1], tool.contact_force[2]});
    least = std::min(least, force);
    most = std::max(most, force);
  }
  std::printf("    pressed with %.2f to %.2f N; the fact says %.3f N a beat\n", least, most, felt(right, one));
  EXPECT_GT(felt(right, one), 0.02);
  EXPECT_LT(felt(right, one), 0.5);
  EXPECT_EQ(felt(right, -1), felt(right, one));
  EXPECT_EQ(felt(right, two), 0);
  EXPECT_EQ(felt(left, one), 0);
}

// Said with no probe anywhere; pressed with 3 N on nothing that beats.
TEST(PulsePalpation, WhatIsSaidWhereNothingBeatsAndWhatIsPressedTooHardAreErrors) {
  const sim::Model& model = cushions();
  sim::State state = sim::initial_state(model);
  Monitor monitor(palpation(), model);
  sim::StepReport report;
  report.events[0] = sim::Event::of_hand(sim::Event::declared, 0);
  report.event_count = 1;
  state.declaring = 1;
  monitor.update(model, state, report);
  ASSERT_EQ(monitor.errors().size(), 1u);
  EXPECT_EQ(monitor.errors()[0].code, "P1");
  state.declaring = 0;
  state.tools[1].contact_force[2] = 3;
  for (int i = 0; i < 20; ++i) {
    state.tick += 20;
    monitor.update(model, state, {});
  }
  ASSERT_EQ(monitor.errors().size(), 2u);
  EXPECT_EQ(monitor.errors()[1].code, "P2");
}

}  // namespace
}  // namespace trocar::training
