// A recording is held against what its inputs give: States, keyframes, marks, and the result at its end.
#include <filesystem>
#include <fstream>
#include <functional>

#include <gtest/gtest.h>
#include <unistd.h>

#include <trocar/attempt/verification/result_check.hpp>
#include <trocar/attempt/verification/state_check.hpp>

#include "../sim/small_scene.hpp"

namespace trocar::attempt {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kTicks = 450;

/// Two steps and an error, by the clock.
std::string exercise_text(const char* pass_mark) {
  return std::string(R"({"format": 3, "name": "small", "title": "Small", "scene": "scene.json",
    "score": {"quality": 60, "time": 25, "motion": 15, "source": "our estimate"}, "hold_s": 0.02, "expert_s": 10,
    "longest_s": 100, "pass_mark": )") +
         pass_mark + R"(,
    "steps": [{"step": "first", "title": "First", "when": {"fact": "attempt.time_s", "min": 0.1}},
              {"step": "second", "title": "Second", "when": {"fact": "attempt.time_s", "min": 0.3}}],
    "errors": [{"code": "E1", "name": "late", "points": 10, "meaning": "Too late", "source": "our estimate",
                "when": {"fact": "attempt.time_s", "min": 0.2}}]})";
}

std::unique_ptr<Lesson> lesson_with(const char* pass_mark) {
  auto l = std::make_unique<Lesson>();
  l->name = "small";
  l->model = small::model();
  const scene::MemoryFiles files{{"exercise.json", exercise_text(pass_mark)}};
  l->exercise = training::read_exercise("exercise.json", &files);
  return l;
}
const Lesson& lesson() {
  static const std::unique_ptr<Lesson> made = lesson_with("80");
  return *made;
}

std::string file(const char* name) {
  return (fs::temp_directory_path() / ("trocar_verification_" + std::to_string(getpid()) + name)).string();
}

/// An attempt of the small hands, as its recording holds it.
const sim::Recording& recorded() {
  static const sim::Recording made = [] {
    const std::string path = file(".rec");
    Session session(lesson(), 1);
    session.record(path, training::Attempt{});
    small::Hands hands(lesson().model);
    while (session.state().tick < kTicks) session.advance(hands.next(session.state()));
    EXPECT_EQ(session.finish(session.result(false)), "");
    sim::Recording r = sim::read_recording(path);
    fs::remove(path);
    return r;
  }();
  return made;
}

/// What a verification of these inputs and marks says; empty: nothing is wrong.
std::string fault_of(const sim::Recording& r, const Lesson& l = lesson(), std::string* not_compared = nullptr) {
  Session session(l, 1);
  StateCheck states(l.model, r);
  bool good = states.check(session);
  while (good && session.state().tick < r.inputs.size()) {
    session.advance(r.inputs[session.state().tick]);
    good = states.check(session);
  }
  if (const std::string fault = states.fault(); !fault.empty()) return fault;
  const ResultCheck result = check_result(r, l, session.result(was_aborted(r)));
  if (not_compared) *not_compared = result.not_compared;
  return result.difference;
}

void expect_fault(const std::string& says, const std::function<void(sim::Recording&)>& change) {
  sim::Recording changed = recorded();
  change(changed);
  EXPECT_NE(fault_of(changed).find(says), std::string::npos) << "expected " << says << "\ngot " << fault_of(changed);
}

void forge(sim::Recording& r, const char* pointer, const Json& value) {
  Json result = Json::parse(r.result_json);
  result[Json::json_pointer(pointer)] = value;
  r.result_json = result.dump();
}

TEST(Verification, OfWhatWasRecordedFindsNothing) {
  ASSERT_TRUE(recorded().complete) << recorded().damage;
  const Json result = Json::parse(recorded().result_json);
  ASSERT_EQ(result["assessment"]["errors"].size(), 1u) << result.dump(1);
  ASSERT_TRUE(result["assessment"]["steps"][1]["done"].get<bool>());
  std::string not_compared;
  EXPECT_EQ(fault_of(recorded(), lesson(), &not_compared), "");
  EXPECT_EQ(not_compared, "");
  EXPECT_EQ(recorded().hashes.size(), 6u) << "0 to 400, and the last tick";
}

TEST(Verification, FindsAForgedResult) {
  const double total = Json::parse(recorded().result_json)["assessment"]["score"]["total"].get<double>();
  expect_fault("assessment/score/total: 100 and " + Json(total).dump(),
               [](sim::Recording& r) { forge(r, "/assessment/score/total", 100); });
  expect_fault("passed: false and true", [](sim::Recording& r) { forge(r, "/passed", false); });
  expect_fault("assessment/errors", [](sim::Recording& r) { forge(r, "/assessment/errors", Json::array()); });
  expect_fault("assessment/errors/0/code", [](sim::Recording& r) { forge(r, "/assessment/errors/0/code", "E2"); });
  expect_fault("assessment/steps/0/done", [](sim::Recording& r) { forge(r, "/assessment/steps/0/done", false); });
  expect_fault("metrics", [](sim::Recording& r) { forge(r, "/metrics/duration_s", 1e-3); });
  expect_fault("cannot be read", [](sim::Recording& r) { r.result_json = "[]"; });
  expect_fault("which may have judged otherwise", [](sim::Recording& r) {
    forge(r, "/passed", false);
    r.header.program_version = "9.9.9";
  });
}

TEST(Verification, SaysWhyTheScoreIsNotCompared) {
  std::string why;
  EXPECT_EQ(fault_of(recorded(), *lesson_with("70"), &why), "");
  EXPECT_EQ(why, "the exercise has changed since");
  sim::Recording old = recorded();
  old.header.metadata_json = R"({"trainee": "ada"})";
  EXPECT_EQ(fault_of(old, lesson(), &why), "");
  EXPECT_EQ(why, "the recording does not say which exercise file it was made with");
  sim::Recording killed = recorded();
  killed.complete = false;
  EXPECT_EQ(fault_of(killed, lesson(), &why), "");
  EXPECT_EQ(why, "the recording has no result");
}

TEST(Verification, FindsTicksBehindTheLastHash) {
  expect_fault("verified until tick 450 of 700: expected no state hash of tick 450, got one",
               [](sim::Recording& r) { r.inputs.resize(700, r.inputs.back()); });
  expect_fault("verified until tick 400 of 700: the state hash of tick 500 is missing", [](sim::Recording& r) {
    r.inputs.resize(700, r.inputs.back());
    r.hashes.pop_back();
  });
  expect_fault("verified until tick 400 of 450: the state hash of tick 450 is missing",
               [](sim::Recording& r) { r.hashes.pop_back(); });
}

TEST(Verification, FindsMarksThatAreMissingOrMoved) {
  expect_fault("the state hash of tick 200 is missing",
               [](sim::Recording& r) { r.hashes.erase(r.hashes.begin() + 2); });
  expect_fault("the state hash of tick 200 is missing", [](sim::Recording& r) { r.hashes[2].tick = 230; });
  expect_fault("expected no state hash of tick 150", [](sim::Recording& r) { r.hashes[2].tick = 150; });
  expect_fault("the keyframe of tick 300 is missing",
               [](sim::Recording& r) { r.keyframes.erase(r.keyframes.begin() + 3); });
  expect_fault("holds no state hash", [](sim::Recording& r) { r.hashes.clear(); });
}

TEST(Verification, LetsARecordingThatWasInterruptedEndBeforeItsLastMarks) {
  sim::Recording r = recorded();
  r.complete = false;
  r.hashes.resize(3), r.keyframes.resize(2);
  EXPECT_EQ(fault_of_hashes(r), "");
  EXPECT_EQ(fault_of_keyframes(r), "");
  r.hashes.erase(r.hashes.begin() + 1);
  EXPECT_NE(fault_of_hashes(r), "");
}

TEST(Verification, FindsAKeyframeThatShowsSomethingElse) {
  for (const double part : {0.05, 0.3, 0.6, 0.99})
    expect_fault("the keyframe of tick 200 does not show the state", [part](sim::Recording& r) {
      std::vector<std::uint8_t>& bytes = r.keyframes[2].bytes;
      bytes[std::size_t(part * double(bytes.size()))] ^= 0x08;
    });
  expect_fault("does not fit the scene", [](sim::Recording& r) { r.keyframes[1].bytes.resize(10); });
}

TEST(Verification, FindsAnotherState) {
  expect_fault("the state differs after tick 200; it agreed until tick 100",
               [](sim::Recording& r) { r.hashes[2].hash ^= 1; });
  expect_fault("the first state differs", [](sim::Recording& r) { r.hashes[0].hash ^= 1; });
}

}  // namespace
}  // namespace trocar::attempt
