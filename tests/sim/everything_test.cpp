// Blood, water, smoke, heat and tissue all at once (everything.hpp): what is recorded of it verifies, and a State saved
// in the midst of it goes on with the same bits.
#include "everything.hpp"

#include <filesystem>

#include <gtest/gtest.h>
#include <unistd.h>

#include <trocar/core/parallel.hpp>
#include <trocar/sim/recording/keyframe.hpp>
#include <trocar/sim/recording/recording.hpp>
#include <trocar/sim/recording/shown_difference.hpp>

using namespace trocar;
using namespace trocar::sim;

namespace {

constexpr int kDrops = 3000;
constexpr std::uint64_t kTicks = 1000, kMiddle = 750;

const Model& model() { return everything::model(); }

/// Drops, a pool, and a lens that is fogged already, so that it is wiped from the first time on.
State start() {
  State s = everything::laden(model(), kDrops);
  s.fluids.smoke.fog = 0.5;
  return s;
}

/// Both pedals in turn: the hook coagulates, then cuts.
Input input_at(const everything::Hands& hands, std::uint64_t tick) {
  Input input = hands.at(tick);
  if (tick >= 700 && tick % 500 >= 400) input.pedals = (input.pedals & ~std::uint32_t(kBlue)) | kYellow;
  return input;
}

/// What was on at one time or another.
struct Seen {
  std::uint32_t pedals = 0;
  int most_drops = 0, most_impacts = 0, most_bricks = 0;
  bool current = false;
};

struct Session {
  std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / ("trocar_everything_" + std::to_string(getpid()));
  State middle, end;
  Seen seen;
  std::uint32_t flags = 0;

  Session() {
    RecordingHeader header;
    header.model_hash = model().hash;
    RecordingWriter writer(file, header);
    const everything::Hands hands(model());
    State s = start();
    Work w = make_work(model());
    while (s.tick < kTicks) {
      if (s.tick % kHashEvery == 0) writer.hash(s.tick, hash_of(s));
      if (s.tick % kKeyframeEvery == 0) writer.keyframe(s.tick, display_bytes(model(), s));
      if (s.tick == kMiddle) middle = s;
      const Input input = input_at(hands, s.tick);
      writer.tick(s.tick, input);
      flags |= step(model(), input, s, w).flags;
      look_at(s, w, input);
    }
    writer.finish("{}");
    end = std::move(s);
  }
  ~Session() { std::filesystem::remove(file); }

 private:
  void look_at(const State& s, const Work& w, const Input& input) {
    seen.pedals |= input.pedals;
    seen.most_drops = std::max(seen.most_drops, s.fluids.droplets.count);
    seen.most_impacts = std::max(seen.most_impacts, s.impact_count);
    seen.most_bricks = std::max(seen.most_bricks, tissue::bricks_awake(s.heat));
    seen.current = seen.current || w.current_flows;
  }
};

const Session& session() {
  static const Session recorded;
  return recorded;
}

/// Of the last first_difference(): what is drawn otherwise than in the recording.
std::string differing_field;

/// Steps a State on through a recording. @return the first mark whose hash is another, or kTicks + 1
std::uint64_t first_difference(const Recording& recording, State s, Work w, bool poisoned = false) {
  differing_field.clear();
  while (s.tick < recording.inputs.size()) {
    if (s.tick % kHashEvery == 0 && hash_of(s) != recording.hashes[s.tick / kHashEvery].hash) {
      if (s.tick % kKeyframeEvery == 0)
        differing_field = shown_difference(model(), recording.keyframes[s.tick / kKeyframeEvery].bytes, s);
      return s.tick;
    }
    if (poisoned) poison(w);
    step(model(), recording.inputs[s.tick], s, w);
  }
  differing_field = sim::first_difference(session().end, s);
  return hash_of(s) == hash_of(session().end) ? kTicks + 1 : kTicks;
}

}  // namespace

TEST(Everything, IsOnInTheSessionOfTheseTests) {
  const Session& r = session();
  const State& s = r.end;
  EXPECT_EQ(model().vessels.list.size(), std::size_t(everything::kSegments));
  EXPECT_EQ(r.seen.pedals & 7u, 7u) << "both pedals and the wipe";
  EXPECT_TRUE(r.seen.current);
  EXPECT_GT(r.seen.most_drops, kDrops * 9 / 10) << "some join at once";
  EXPECT_GT(r.seen.most_impacts, 0);
  EXPECT_GT(r.seen.most_bricks, 5);
  EXPECT_GT(s.flow.bled, fluids::kMillilitre / 10);
  EXPECT_GT(s.fluids.ledger.in[std::size_t(fluids::Source::kIrrigated)].total(), fluids::kMillilitre);
  EXPECT_GT(at(s.fluids.ledger, fluids::Place::kSucked).total(), fluids::kMillilitre / 10);
  EXPECT_GT(at(s.fluids.ledger, fluids::Place::kPool).total(), 100 * fluids::kMillilitre);
  EXPECT_GT(at(s.fluids.ledger, fluids::Place::kFilm).total(), 0);
  EXPECT_GT(content(model().wet.model.smoke, s.fluids.smoke), 0);
  EXPECT_LT(s.fluids.smoke.fog, 0.5) << "wiped";
  EXPECT_GT(s.fluids.smoke.fog, 0);
  EXPECT_TRUE(audit(model().wet.model, s.fluids));
  EXPECT_EQ(r.flags & ~std::uint32_t(tissue::StepReport::kInverted), 0u);
}

TEST(Everything, ARecordingOfItVerifiesFromItsStartAndFromTheMiddleOnAnyThreads) {
  const Recording recording = read_recording(session().file);
  ASSERT_TRUE(recording.complete) << recording.damage;
  ASSERT_EQ(recording.inputs.size(), kTicks);
  core::ThreadPool two(2);
  EXPECT_EQ(first_difference(recording, start(), make_work(model()), true), kTicks + 1)
      << "scratch full of NaN: " << differing_field;
  EXPECT_EQ(first_difference(recording, start(), make_work(model(), &two)), kTicks + 1)
      << "two threads: " << differing_field;
  EXPECT_EQ(first_difference(recording, session().middle, make_work(model())), kTicks + 1)
      << "from the middle: " << differing_field;
  EXPECT_EQ(first_difference(recording, session().middle, make_work(model(), &two)), kTicks + 1)
      << "from the middle, two threads: " << differing_field;
}

TEST(Everything, AnInputThatDiffersInOneBitOfAPedalIsNoticed) {
  Recording recording = read_recording(session().file);
  recording.inputs[kMiddle + 20].pedals ^= irrigates(everything::kIrrigator);
  EXPECT_EQ(first_difference(recording, session().middle, make_work(model())), 800u);
}

TEST(Everything, KeyframesShowItAsItWas) {
  const Recording recording = read_recording(session().file);
  State shown = initial_state(model());
  for (const Keyframe& key : recording.keyframes) {
    ASSERT_TRUE(restore_display(model(), key.bytes, shown)) << key.tick;
    EXPECT_EQ(display_bytes(model(), shown), key.bytes) << key.tick;
  }
}
