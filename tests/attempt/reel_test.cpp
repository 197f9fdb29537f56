// What a player needs without its window: timeline, kept States, footage between keyframes, and the thread that does a
// recording again. The recording is of the small scene: a tube grasped, lifted, clipped twice and cut in 4.4 seconds.
#include <chrono>
#include <map>
#include <thread>

#include <gtest/gtest.h>

#include <trocar/attempt/footage.hpp>
#include <trocar/attempt/kept_states.hpp>
#include <trocar/attempt/reel.hpp>
#include <trocar/attempt/session.hpp>
#include <trocar/attempt/timeline.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/random.hpp>
#include <trocar/sim/recording/keyframe.hpp>

#include "../sim/small_scene.hpp"

namespace trocar::attempt {
namespace {

// --- timeline ---

TEST(Timeline, EveryTickLiesWhereItsPlaceLeadsBackToIt) {
  attempt::Timeline line(60'000);
  for (const std::uint64_t tick : {0ull, 1ull, 12'345ull, 59'999ull, 60'000ull})
    EXPECT_EQ(line.tick_at(line.place(double(tick))), tick);
  line.zoom(0.01, 30'000);
  for (std::uint64_t tick = std::uint64_t(line.from()) + 1; double(tick) < line.to(); tick += 37)
    EXPECT_EQ(line.tick_at(line.place(double(tick))), tick);
  EXPECT_EQ(line.tick_at(-1e9), 0u);
  EXPECT_EQ(line.tick_at(1e9), 60'000u);
}

TEST(Timeline, ZoomKeepsWhatIsUnderThePointerAndStaysInside) {
  attempt::Timeline line(60'000);
  line.zoom(0.25, 20'000);
  EXPECT_NEAR(line.place(20'000), 1.0 / 3, 1e-9);
  EXPECT_NEAR(line.to() - line.from(), 15'000, 1e-6);
  line.zoom(1e-9, 20'000);
  EXPECT_NEAR(line.to() - line.from(), double(attempt::kFrameTicks), 1e-6);
  line.pan(-1e6);
  EXPECT_EQ(line.from(), 0);
  line.pan(1e9);
  EXPECT_NEAR(line.to(), 60'000, 1e-6);
  line.zoom(1e9, 0);
  EXPECT_TRUE(line.shows_all());
}

TEST(Timeline, FollowsWhatLeavesTheVisibleStretchAndNothingElse) {
  attempt::Timeline line(60'000);
  line.zoom(0.1, 0);
  line.follow(3000);
  EXPECT_EQ(line.from(), 0);
  line.follow(6500);
  EXPECT_GT(line.from(), 0);
  EXPECT_GE(line.place(6500), 0);
  EXPECT_LE(line.place(6500), 1);
}

TEST(Timeline, ARecordingOfNothingDividesByNothing) {
  attempt::Timeline line(0);
  EXPECT_EQ(line.place(0), 0);
  EXPECT_EQ(line.tick_at(0.5), 0u);
  line.zoom(0.5, 0);
  line.follow(0);
  EXPECT_EQ(line.tick_at(1), 0u);
}

TEST(Timeline, GridLinesLeaveRoomForTheirLabels) {
  attempt::Timeline line(3'600'000);
  EXPECT_EQ(line.grid(10), 500);
  line.zoom(1.0 / 3600, 0);
  EXPECT_EQ(line.grid(10), 0.1);
}

TEST(Timeline, MarksFollowOneAnotherBothWays) {
  using Kind = attempt::TimelineMark::Kind;
  std::vector<attempt::TimelineMark> marks{{Kind::error, 500, "b"}, {Kind::event, 100, "a"}, {Kind::step, 500, "c"}};
  attempt::sort_marks(marks);
  EXPECT_EQ(marks[1].text, "b");
  EXPECT_EQ(attempt::next_mark(marks, 0)->tick, 100u);
  EXPECT_EQ(attempt::next_mark(marks, 100)->tick, 500u);
  EXPECT_EQ(attempt::next_mark(marks, 500), nullptr);
  EXPECT_EQ(attempt::previous_mark(marks, 500)->tick, 100u);
  EXPECT_EQ(attempt::previous_mark(marks, 100), nullptr);
  EXPECT_EQ(attempt::next_mark({}, 0), nullptr);
}

TEST(Timeline, SpeedsGoFromATenthToEightfold) {
  double speed = 1;
  for (int i = 0; i < 20; ++i) speed = attempt::next_speed(speed, true);
  EXPECT_EQ(speed, 8);
  for (int i = 0; i < 20; ++i) speed = attempt::next_speed(speed, false);
  EXPECT_EQ(speed, 0.1);
  EXPECT_EQ(attempt::next_speed(0.7, true), 1);
  EXPECT_EQ(attempt::next_speed(0.7, false), 0.5);
}

// --- kept States ---

sim::State small_state(std::uint64_t tick) {
  sim::State s;
  s.tick = tick;
  s.nearest.assign(1000, 0);
  return s;
}

TEST(KeptStates, StayWithinTheirMemoryAndEvenlySpread) {
  const std::size_t each = attempt::bytes_of(small_state(0));
  attempt::KeptStates kept(20 * each, 100);
  for (std::uint64_t tick = 0; tick <= 50'000; ++tick) {
    if (kept.wants(tick)) kept.keep(small_state(tick));
    ASSERT_LE(kept.bytes(), 20 * each);
  }
  EXPECT_EQ(kept.spacing(), 3200u);
  EXPECT_GE(kept.size(), 10u);
  for (std::uint64_t tick = 0; tick <= 50'000; tick += 777) {
    const sim::State* near = kept.before(tick);
    ASSERT_NE(near, nullptr);
    EXPECT_LE(near->tick, tick);
    EXPECT_LT(tick - near->tick, 2 * kept.spacing());
  }
}

TEST(KeptStates, OneIsKeptHoweverLittleMemoryThereIs) {
  attempt::KeptStates kept(1, 10);
  for (std::uint64_t tick = 0; tick <= 100; ++tick)
    if (kept.wants(tick)) kept.keep(small_state(tick));
  ASSERT_NE(kept.before(100), nullptr);
  EXPECT_EQ(kept.before(100)->tick, 0u);
}

TEST(RecentStates, TheNewestFewStayAndTheNearestIsFound) {
  attempt::RecentStates recent(3);
  EXPECT_EQ(recent.before(5), nullptr);
  for (const std::uint64_t tick : {40, 80, 120, 160}) recent.keep(small_state(tick));
  EXPECT_EQ(recent.before(100)->tick, 80u);
  EXPECT_EQ(recent.before(1000)->tick, 160u);
  EXPECT_EQ(recent.before(50), nullptr);  // 40 had to go
}

// --- a recording ---

struct Recorded {
  attempt::Lesson lesson;
  sim::Recording recording;
  std::vector<std::uint64_t> hash;  ///< of the State, by tick
};

const Recorded& recorded() {
  static const auto made = [] {
    auto r = std::make_unique<Recorded>();
    r->lesson.name = "small";
    r->lesson.model = small::model();
    attempt::Session session(r->lesson, 1);
    small::Hands hands(r->lesson.model);
    r->recording.header.model_hash = r->lesson.model.hash;
    r->recording.complete = true;
    for (;;) {
      const std::uint64_t tick = session.state().tick;
      r->hash.push_back(sim::hash_of(session.state()));
      if (tick % sim::kHashEvery == 0) r->recording.hashes.push_back({tick, session.mark()});
      if (tick % sim::kKeyframeEvery == 0)
        r->recording.keyframes.push_back({tick, sim::display_bytes(r->lesson.model, session.state())});
      if (hands.done()) break;
      r->recording.inputs.push_back(hands.next(session.state()));
      session.advance(r->recording.inputs.back());
    }
    return r;
  }();
  return *made;
}

/// Waits until the reel has the exact State of a tick.
bool arrives(attempt::Reel& reel, std::uint64_t tick) {
  reel.look_at(tick, false);
  for (int i = 0; i < 30'000; ++i) {
    reel.refresh();
    if (reel.way_to_go() == 0 && reel.exact().tick == tick) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

bool looks_through(const attempt::Reel& reel) {
  for (int i = 0; i < 60'000 && !reel.complete(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return reel.complete();
}

TEST(Footage, IsExactAtKeyframesAndHalfwayBetweenThem) {
  const Recorded& r = recorded();
  const sim::Model& model = r.lesson.model;
  attempt::Footage footage(model, r.recording.keyframes);
  sim::State key = sim::initial_state(model), next = key;
  for (const std::size_t i : {0u, 7u, 20u, 43u}) {
    ASSERT_TRUE(sim::restore_display(model, r.recording.keyframes[i].bytes, key));
    EXPECT_EQ(sim::display_bytes(model, footage.at(r.recording.keyframes[i].tick)), r.recording.keyframes[i].bytes)
        << i;
  }
  ASSERT_TRUE(sim::restore_display(model, r.recording.keyframes[8].bytes, key));
  ASSERT_TRUE(sim::restore_display(model, r.recording.keyframes[9].bytes, next));
  const sim::State& between = footage.at(850);
  for (std::size_t n = 0; n < key.strands[0].x.size(); ++n)
    EXPECT_NEAR(length(between.strands[0].x[n] - 0.5 * (key.strands[0].x[n] + next.strands[0].x[n])), 0, 1e-12);
  EXPECT_NEAR(between.tools[0].depth, 0.5 * (key.tools[0].depth + next.tools[0].depth), 1e-12);
  EXPECT_NE(key.tools[0].depth, next.tools[0].depth);
  EXPECT_TRUE(footage.sound());
}

TEST(Footage, FogOnTheLensIsHalfwayToo) {
  const sim::Model& model = recorded().lesson.model;
  ASSERT_TRUE(model.wet.there);
  sim::State a = sim::initial_state(model), b = a, between = a;
  a.fluids.smoke.fog = 0.8, b.fluids.smoke.fog = 0.6;
  a.fluids.smoke.wipe_left = 4, b.fluids.smoke.wipe_left = 3.9;
  blend(model, a, b, 0.5, between);
  EXPECT_NEAR(between.fluids.smoke.fog, 0.7, 1e-12);
  EXPECT_NEAR(between.fluids.smoke.wipe_left, 3.95, 1e-12);
  a.fluids.smoke.wipe_left = 0, b.fluids.smoke.wipe_left = 8;
  blend(model, a, b, 0.5, between);
  EXPECT_EQ(between.fluids.smoke.wipe_left, 0) << "a wipe begins with the keyframe that has it";
}

TEST(Footage, AKeyframeThatDoesNotFitEndsIt) {
  const Recorded& r = recorded();
  std::vector<sim::Keyframe> keys(r.recording.keyframes.begin(), r.recording.keyframes.begin() + 10);
  keys[5].bytes.pop_back();
  attempt::Footage footage(r.lesson.model, keys);
  footage.at(450);
  footage.at(520);
  EXPECT_FALSE(footage.sound());
  EXPECT_EQ(footage.last(), 400u);
  EXPECT_EQ(sim::display_bytes(r.lesson.model, footage.at(800)), keys[4].bytes);
  keys = {r.recording.keyframes[0], r.recording.keyframes[2], r.recording.keyframes[1]};
  attempt::Footage backwards(r.lesson.model, keys);
  EXPECT_FALSE(backwards.sound());
  EXPECT_EQ(backwards.count(), 2u);
}

TEST(Reel, ScrubbingBackAndForthGivesTheVeryStatesOfTheAttempt) {
  const Recorded& r = recorded();
  attempt::Reel::Options options;
  options.threads = 1;
  attempt::Reel reel(r.lesson, r.recording, options);
  ASSERT_TRUE(reel.replays());
  ASSERT_EQ(reel.last(), r.recording.inputs.size());
  core::Random random(7);
  std::uint64_t tick = 0;
  for (int i = 0; i < 40; ++i) {
    switch (i % 4) {
      case 0:
        tick = std::uint64_t(random.uniform() * double(reel.last()));
        break;
      case 1:
        tick = tick > 0 ? tick - 1 : 0;  // a tick back
        break;
      case 2:
        tick = tick > 40 ? tick - 40 : 0;
        break;
      default:
        tick = std::min(tick + 41, reel.last());
    }
    ASSERT_TRUE(arrives(reel, tick)) << tick;
    EXPECT_EQ(sim::hash_of(reel.exact()), r.hash[tick]) << tick;
  }
  ASSERT_TRUE(arrives(reel, reel.last()));
  EXPECT_EQ(sim::hash_of(reel.exact()), r.hash.back());
}

TEST(Reel, FindsEveryEventWithItsTick) {
  const Recorded& r = recorded();
  attempt::Reel reel(r.lesson, r.recording, {});
  ASSERT_TRUE(looks_through(reel));
  attempt::Findings found;
  std::uint64_t version = 0;
  ASSERT_TRUE(reel.findings(version, found));
  EXPECT_FALSE(reel.findings(version, found));
  EXPECT_TRUE(found.difference.empty()) << found.difference;
  EXPECT_EQ(reel.differs_from(), attempt::Reel::kNowhere);
  std::map<std::string, int> seen;
  std::uint64_t before = 0;
  for (const attempt::TimelineMark& m : found.marks) {
    EXPECT_GE(m.tick, before);
    before = m.tick;
    ++seen[m.text.substr(0, m.text.find(' '))];
  }
  EXPECT_EQ(seen["clip"], 2);
  EXPECT_GE(found.marks.size(), 4u);  // grasped, clipped twice, cut
}

TEST(Reel, KeepsWithinItsMemory) {
  const Recorded& r = recorded();
  attempt::Reel::Options options;
  options.spacing = 100;
  options.budget = 6 * attempt::bytes_of(sim::initial_state(r.lesson.model));
  attempt::Reel reel(r.lesson, r.recording, options);
  ASSERT_TRUE(looks_through(reel));
  EXPECT_LE(reel.kept_bytes(), options.budget);
  EXPECT_GT(reel.spacing(), options.spacing);
  ASSERT_TRUE(arrives(reel, 3210));
  EXPECT_EQ(sim::hash_of(reel.exact()), r.hash[3210]);
}

TEST(Reel, SaysFromWhereDoingItAgainIsNotWhatWasRecorded) {
  const Recorded& r = recorded();
  sim::Recording changed = r.recording;
  changed.hashes[20].hash ^= 1;  // after 2000 ticks
  attempt::Reel reel(r.lesson, changed, {});
  ASSERT_TRUE(looks_through(reel));
  EXPECT_EQ(reel.differs_from(), 1901u);
  attempt::Findings found;
  std::uint64_t version = 0;
  reel.findings(version, found);
  EXPECT_NE(found.difference.find("0:02.000"), std::string::npos) << found.difference;
  ASSERT_TRUE(arrives(reel, 1900));
  EXPECT_EQ(sim::hash_of(reel.exact()), r.hash[1900]);
}

TEST(Reel, AnotherPhysicsIsNotDoneAgainAndItsKeyframesTellWhatHappened) {
  const Recorded& r = recorded();
  sim::Recording other = r.recording;
  other.header.model_hash ^= 1;
  other.result_json = R"({"assessment":{"steps":[{"name":"Clip","done":true,"at_s":2.5},{"name":"Cut","done":false}],)"
                      R"("errors":[{"code":"A1.1","meaning":"no","at_s":1.25}]}})";
  attempt::Reel reel(r.lesson, other, {});
  EXPECT_FALSE(reel.replays());
  EXPECT_EQ(reel.last(), r.recording.keyframes.back().tick);
  ASSERT_TRUE(looks_through(reel));
  attempt::Findings found;
  std::uint64_t version = 0;
  ASSERT_TRUE(reel.findings(version, found));
  int clips = 0, cuts = 0, errors = 0;
  for (const attempt::TimelineMark& m : found.marks) {
    clips += m.text == "a clip closed";
    cuts += m.text == "a cut";
    errors += m.kind == attempt::TimelineMark::Kind::error && m.tick == 1250;
  }
  EXPECT_EQ(clips, 2);
  EXPECT_GE(cuts, 1);
  EXPECT_EQ(errors, 1);
  ASSERT_NE(found.guide_at(3000), nullptr);
  EXPECT_EQ(found.guide_at(3000)->current, 1);
  EXPECT_EQ(found.guide_at(2499)->current, 0);
}

TEST(Reel, AResultThatIsNonsenseGivesNothing) {
  for (const char* text :
       {"", "{", "[]", "{\"assessment\":3}", "{\"assessment\":{\"steps\":[3,{\"done\":1}],\"errors\":{}}}",
        "{\"assessment\":{\"steps\":[{\"name\":7,\"done\":true,\"at_s\":\"x\"}]}}"})
    EXPECT_LE(attempt::findings_of_result(text).marks.size(), 1u) << text;
  EXPECT_TRUE(attempt::findings_of_result("").marks.empty());
}

}  // namespace
}  // namespace trocar::attempt
