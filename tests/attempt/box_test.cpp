// An attempt led by an instrument box: its file, which hand is which, and how commands follow hands.
#include <cmath>

#include <gtest/gtest.h>
#include <unistd.h>

#include <trocar/attempt/box/box_file.hpp>
#include <trocar/attempt/box/box_playback.hpp>
#include <trocar/attempt/box/box_source.hpp>
#include <trocar/attempt/catch_up.hpp>
#include <trocar/attempt/lesson.hpp>
#include <trocar/core/error.hpp>

#include "plugged_box.hpp"

namespace trocar::attempt {
namespace {

using devices::BoxActor;
using devices::BoxAxis;
using devices::BoxPose;
using devices::BoxTime;

const Lesson& scene() {
  static const std::unique_ptr<Lesson> lesson = load_lesson("gynaecology");
  return *lesson;
}

devices::BoxWiring read(const std::string& text, std::vector<core::Fault>& faults) {
  const scene::MemoryFiles files{{"box.json", text}};
  return read_box_file("box.json", faults, &files);
}

std::string faults_of(const std::string& text) {
  std::vector<core::Fault> faults;
  read(text, faults);
  std::string all;
  for (const core::Fault& f : faults) all += core::to_string(f) + "\n";
  return all;
}

TEST(BoxFile, TheBuiltInWiringIsWrittenAndReadAgainAsTheSame) {
  const devices::BoxWiring& wiring = devices::default_wiring();
  std::vector<core::Fault> faults;
  const devices::BoxWiring again = read(box_file_text(wiring), faults);
  EXPECT_TRUE(faults.empty()) << core::to_string(faults.front());
  EXPECT_EQ(box_file_text(again), box_file_text(wiring));
  EXPECT_EQ(again.mask(), wiring.mask());
  EXPECT_EQ(again.buttons, wiring.buttons);
  EXPECT_EQ(again.pedals, wiring.pedals);
  for (int actor = 0; actor < devices::kBoxActors; ++actor)
    for (int axis = 0; axis < devices::kBoxAxes; ++axis)
      for (const double code : {0.0, 1000.0, 4095.0})
        EXPECT_NEAR(again.axis(BoxActor(actor), BoxAxis(axis)).table.value(code),
                    wiring.axis(BoxActor(actor), BoxAxis(axis)).table.value(code), 1e-10);
}

TEST(BoxFile, FaultsAreToldAllInOnePassWithTheirPlaces) {
  const std::string all = faults_of(R"({"format": 1, "baud": 12345, "zero": "placd",
  "hands": [
    {"hand": "left", "yaw": {"channel": 3, "deg": [[10, 1], [5, 2]]},
     "pitch": {"channel": 3, "deg": [[0, 1], [5, 2]]}, "roll": {"channel": 3, "deg": [[0, 1], [5, 2]]},
     "depth": {"channel": 48, "mm": [[0, 1], [5, 2]]}, "irrigate": 4, "suck": 4},
    {"hand": "left", "handle": {"channel": 9, "closed": [[0, 1, 2], [1, 2, 3]]}}],
  "pedals": {"coagulate": 32}})");
  for (const char* told : {"box.json:1:23: expected a usual rate, got 12345", "did you mean \"placed\"",
                           "box.json:3:51: expected codes that rise", "box.json:4:76: expected a channel that is free",
                           "box.json:5:27", "box.json:5:79: expected a bit that is free",
                           "box.json:6:14: expected each hand once", "got 3 columns", "box.json:7:27"})
    EXPECT_NE(all.find(told), std::string::npos) << told << " in\n" << all;
}

TEST(BoxFile, MoreBlocksThanTheLineCarriesAreAFault) {
  devices::BoxWiring wiring = devices::default_wiring();
  wiring.rate = 81;
  const std::string told = faults_of(box_file_text(wiring));
  EXPECT_NE(told.find("expected at most 79.1"), std::string::npos) << told;
  EXPECT_NE(told.find("48 bytes"), std::string::npos) << told;
}

TEST(BoxHands, LeftIsLeftInThePicture) {
  const BoxHands hands(scene().model, devices::default_wiring());
  EXPECT_EQ(scene().model.hands[size_t(hands.hand_of(BoxActor::left))].name, "left_lateral");
  EXPECT_EQ(scene().model.hands[size_t(hands.hand_of(BoxActor::right))].name, "right_lateral");
}

/// An input with everything a little different from how it is placed.
sim::Input bent(double by) {
  sim::Input input = scene().model.start;
  for (int h = 0; h < int(scene().model.hands.size()); ++h) {
    sim::ToolInput& t = input.tools[h];
    t.yaw += float(0.1 * by), t.pitch -= float(0.07 * by), t.roll += float(0.9 * by), t.depth -= float(0.011 * by);
    t.handle = float(0.4 * std::abs(by));
  }
  input.scope.yaw += float(0.2 * by), input.scope.post += float(9 * by);
  input.pedals = sim::kYellow | sim::sucks(1);
  return input;
}

BoxPose pose_of_block(devices::BoxReader& reader, const devices::BoxBlock& block, BoxTime at = 0) {
  devices::BoxPacket packet;
  packet.block = block;
  packet.mask = devices::kAllBoxChannels;
  packet.checked = true;
  packet.acquired = packet.arrived = at;
  return reader.read(packet);
}

TEST(BoxHands, WhatHandsDoComesBackFromTheBlockWithinHalfACode) {
  const BoxHands hands(scene().model, devices::default_wiring());
  for (const double by : {-0.9, -0.2, 0.5, 1.0}) {
    devices::BoxReader reader(devices::default_wiring());
    const sim::Input wanted = bent(by);
    for (const auto& actor : hands.beyond(wanted))
      for (const double axis : actor) EXPECT_EQ(axis, 0);
    sim::Input got = scene().model.start;
    hands.lead(pose_of_block(reader, hands.block_of(wanted)), got);
    EXPECT_EQ(got.pedals, wanted.pedals);
    for (int h = 0; h < int(scene().model.hands.size()); ++h) {
      EXPECT_NEAR(got.tools[h].yaw, wanted.tools[h].yaw, 0.00033);
      EXPECT_NEAR(got.tools[h].pitch, wanted.tools[h].pitch, 0.00033);
      EXPECT_NEAR(got.tools[h].roll, wanted.tools[h].roll, 0.00097);
      EXPECT_NEAR(got.tools[h].depth, wanted.tools[h].depth, 0.00005);
      EXPECT_NEAR(got.tools[h].handle, wanted.tools[h].handle, 0.00016);
      const auto tip = [&](const sim::Input& in) {
        return kinematics::forward(scene().model.hands[size_t(h)].port, pose_of(in.tools[h])).tip;
      };
      EXPECT_LT(length(tip(got) - tip(wanted)), 0.0001) << "half of 0.13 mm, at less depth";
    }
    const double turns = double(got.scope.post - wanted.scope.post) / 6.283185307;
    EXPECT_NEAR(turns, std::round(turns), 0.0003) << "the post is where it was, whole turns aside";
  }
}

// --- how commands follow hands ---

struct Led {
  Led() : hands(scene().model, devices::default_wiring()), state(sim::initial_state(scene().model)) {}

  /// Hands rest at `input`, with these bits pressed, for so many ticks.
  sim::Input rest(const sim::Input& input, int ticks, std::uint32_t pressed = 0) {
    sim::Input out;
    for (int i = 0; i < ticks; ++i, now += 1'000'000) {
      if (now >= next_block) {
        devices::BoxBlock block = hands.block_of(input);
        block.digital |= pressed;
        if (speaks) leader.take(pose_of_block(reader, block, now));
        next_block = now + 20'000'000;
      }
      out = leader.next(state, now);
    }
    return out;
  }

  BoxHands hands;
  sim::State state;
  devices::BoxReader reader{devices::default_wiring()};
  BoxLeader leader{scene().model, devices::default_wiring()};
  BoxTime now = 1'000'000, next_block = 0;
  bool speaks = true;
};

TEST(BoxLeader, FromWhereTheyArePlacedInstrumentsGoToTheHandsNoFasterThanStated) {
  Led led;
  sim::Input far = scene().model.start;
  far.tools[0].depth -= 0.05f;
  float before = scene().model.start.tools[0].depth;
  for (int i = 0; i < 400; ++i) {
    const float depth = led.rest(far, 1).tools[0].depth;
    EXPECT_LE(std::abs(depth - before), kCatchSpeed * 0.001 + 1e-7);
    before = depth;
  }
  EXPECT_NEAR(led.rest(far, 400).tools[0].depth, far.tools[0].depth, 0.0002);
  far.tools[0].depth -= 0.01f;  // now the hand leads: all of it at once, smoothed
  EXPECT_NEAR(led.rest(far, 150).tools[0].depth, far.tools[0].depth, 0.0002);
}

TEST(BoxLeader, JawsKeepTheirGripUntilTheHandleHasComeToIt) {
  Led led;
  sim::Input closed = scene().model.start;
  closed.tools[0].handle = 1;
  EXPECT_EQ(led.rest(closed, 300).tools[0].handle, 0) << "it was closed before anything began";
  led.rest(scene().model.start, 100);
  EXPECT_NEAR(led.rest(closed, 300).tools[0].handle, 1, 0.01);
}

TEST(BoxLeader, ANewInstrumentWaitsInTheTrocarUntilTheHandIsDrawnBack) {
  Led led;
  const sim::Input deep = scene().model.start;
  const int h = led.hands.hand_of(BoxActor::left);
  const std::uint32_t button = 1u << devices::default_wiring().buttons[0][0];
  led.rest(deep, 500);
  EXPECT_EQ(led.rest(deep, 60, button).tools[h].instrument, 1);
  EXPECT_EQ(led.rest(deep, 60).tools[h].instrument, 1) << "once for a press, however long";
  led.state.tools[size_t(h)].instrument = 1;  // the simulation has exchanged it
  EXPECT_LT(led.rest(deep, 500).tools[h].depth, 0.0101);
  EXPECT_TRUE(led.leader.waits_in_trocar(h));
  sim::Input back = deep;
  back.tools[h].depth = 0.04f;
  EXPECT_GT(led.rest(back, 600).tools[h].depth, 0.039) << "it goes with the hand again";
  EXPECT_NEAR(led.rest(deep, 600).tools[h].depth, deep.tools[h].depth, 0.0002);
}

TEST(BoxLeader, WhenTheBoxFallsSilentInstrumentsStandStillAndThePedalIsUp) {
  Led led;
  const sim::Input still = scene().model.start;
  const std::uint32_t pedal = 1;
  EXPECT_EQ(led.rest(still, 300, pedal).pedals, std::uint32_t(sim::kBlue));
  led.speaks = false;
  const sim::Input before = led.rest(still, 200, pedal);
  EXPECT_EQ(led.leader.bridge().freshness(), devices::BoxFreshness::frozen);
  EXPECT_EQ(before.pedals, 0u);
  sim::Input elsewhere = still;
  elsewhere.tools[0].depth -= 0.05f;
  EXPECT_EQ(led.rest(elsewhere, 500, pedal).tools[0].depth, before.tools[0].depth);
  led.speaks = true;
  const float first = led.rest(elsewhere, 50, pedal).tools[0].depth;
  EXPECT_LT(std::abs(first - before.tools[0].depth), 0.006) << "and it does not leap when it is back";
}

TEST(BoxLeader, TheResetPedalIsHeldForASecondToCount) {
  Led led;
  const std::uint32_t reset = 1u << devices::default_wiring().pedals[4];
  led.rest(scene().model.start, 2000, reset);
  EXPECT_FALSE(led.leader.wants_reset()) << "it is down still from the time before";
  led.rest(scene().model.start, 50);
  led.rest(scene().model.start, 900, reset);
  EXPECT_FALSE(led.leader.wants_reset());
  led.rest(scene().model.start, 150, reset);
  EXPECT_TRUE(led.leader.wants_reset());
}

TEST(BoxPlayback, ADemonstrationsExchangesBecomePressesThatEndAtItsInstrument) {
  std::vector<sim::Input> inputs(4000, scene().model.start);
  for (std::size_t t = 1000; t < 4000; ++t) inputs[t].tools[0].instrument = t < 2500 ? 2 : 1;
  const BoxPlayback playback(scene().model, devices::default_wiring(), inputs, 0.5);
  devices::BoxReader reader(devices::default_wiring());
  const auto count = std::uint32_t(scene().model.hands[0].rack.size());
  std::uint32_t in_the_middle = 0, at_the_end = 0;
  for (int n = 0; n < 230; ++n) {
    const BoxPose pose = pose_of_block(reader, playback.at(0.02 * n), BoxTime(n) * 20'000'000);
    const int actor = BoxHands(scene().model, devices::default_wiring()).hand_of(BoxActor::left) == 0 ? 0 : 1;
    at_the_end = pose.changes[size_t(actor)];
    if (n == 140) in_the_middle = at_the_end;
  }
  ASSERT_GT(count, 2u);
  EXPECT_EQ(in_the_middle % count, 2u);
  EXPECT_EQ(at_the_end % count, 1u);
  EXPECT_NEAR(playback.duration(), 4.5, 1e-9);
}

/// All of the way without a port: hands, codes, line, filter, smoothing, on a clock of the test's own.
TEST(BoxChain, TheTipFollowsAHandWithinAFewTenthsOfAMillimetreAndSeventyMilliseconds) {
  const sim::Model& model = scene().model;
  const std::vector<sim::Input> inputs = waving_inputs(model);
  const devices::BoxWiring& wiring = devices::default_wiring();
  const BoxPlayback playback(model, wiring, inputs, 1);
  devices::SoftwareBoxSettings settings;
  settings.noise = 1;
  devices::SoftwareBox box(settings, [&](double seconds) { return playback.at(seconds); });
  devices::BoxDialogue dialogue(devices::dialogue_settings(wiring));
  devices::BoxReader reader(wiring);
  BoxLeader leader(model, wiring);
  const sim::State state = sim::initial_state(model);
  double best = 1;
  std::vector<Vec3d> led;
  for (int tick = 0; tick < 11'000; ++tick) {
    const BoxTime now = BoxTime(tick) * 1'000'000;
    if (tick % 20 == 0) box.hear(dialogue.ask(now), now);
    std::array<std::uint8_t, 64> bytes;
    const std::size_t count = box.due(now, bytes);
    dialogue.hear(std::span(bytes).first(count), now,
                  [&](const devices::BoxPacket& p) { leader.take(reader.read(p)); });
    led.push_back(kinematics::forward(model.hands[0].port, pose_of(leader.next(state, now).tools[0])).tip);
  }
  int lag_of_best = 0;
  for (int lag = 0; lag < 150; ++lag) {
    double squares = 0;
    int n = 0;
    for (int tick = 3000; tick < 10'800; tick += 7, ++n) {
      const Vec3d hand = kinematics::forward(model.hands[0].port, pose_of(inputs[size_t(tick - 1000)].tools[0])).tip;
      squares += dot(hand - led[size_t(tick + lag)], hand - led[size_t(tick + lag)]);
    }
    if (std::sqrt(squares / n) < best) best = std::sqrt(squares / n), lag_of_best = lag;
  }
  RecordProperty("rms_mm", std::to_string(1000 * best));
  RecordProperty("lag_ms", lag_of_best);
  EXPECT_LT(best, 0.0002) << "rms at the tip, with noise of one code";
  EXPECT_LT(lag_of_best, 70);
}

// --- at a port ---

class BoxAtPort : public testing::Test {
 protected:
  void SetUp() override {
    if (!devices::PseudoTerminal::possible()) GTEST_SKIP() << "/dev/ptmx is missing: no pseudo-terminals here";
    port = (std::filesystem::temp_directory_path() / ("trocar_attempt_box_" + std::to_string(getpid()))).string();
  }
  std::string port;
};

TEST_F(BoxAtPort, ASourceLeadsTheHandsInStepsAndLive) {
  const sim::Model& model = scene().model;
  std::vector<sim::Input> inputs(2, model.start);
  for (sim::Input& i : inputs) i.tools[0].yaw += 0.05f;
  const BoxPlayback playback(model, devices::default_wiring(), inputs, 0);
  const PluggedBox box(port, {}, [&](double seconds) { return playback.at(seconds); });
  for (const BoxPace pace : {BoxPace::stepped, BoxPace::live}) {
    const std::unique_ptr<InputSource> source = make_input(scene(), "box:" + port, pace);
    const sim::State state = sim::initial_state(model);
    sim::Input input = model.start;
    for (int tick = 0; tick < 400; ++tick) {
      ASSERT_TRUE(source->next(state, input));
      if (pace == BoxPace::live) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_NEAR(input.tools[0].yaw, model.start.tools[0].yaw + 0.05f, 0.001);
    EXPECT_GT(source->describe()["box"]["blocks"].get<int>(), 10);
    EXPECT_NE(source->device()->text.find("blocks a second"), std::string::npos);
  }
}

TEST_F(BoxAtPort, WithoutABoxItIsToldWhatToDo) {
  EXPECT_THROW(make_input(scene(), "box:" + port, BoxPace::live), core::EnvironmentLacks);
  devices::PseudoTerminal silent(port);
  try {
    make_input(scene(), "box:" + port, BoxPace::stepped);
    FAIL();
  } catch (const core::EnvironmentLacks& lacks) {
    EXPECT_NE(std::string(lacks.what()).find("no box answers"), std::string::npos);
  }
  EXPECT_THROW(make_input(scene(), "box:" + port + "#/no/such/file.json", BoxPace::live), core::BadInput);
  EXPECT_THROW(make_input(scene(), "box:", BoxPace::live), core::BadInput);
}

}  // namespace
}  // namespace trocar::attempt
