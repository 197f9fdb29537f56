// Captions of recordings, and demonstrations that are recorded and kept.
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include <trocar/attempt/paths.hpp>
#include <trocar/attempt/playback/captions.hpp>
#include <trocar/attempt/playback/demonstration_maker.hpp>
#include <trocar/attempt/playback/kept_demonstration.hpp>
#include <trocar/sim/recording/recording.hpp>
#include <trocar/training/exercise/exercise_hash.hpp>

namespace trocar::attempt {
namespace {

namespace fs = std::filesystem;
using Stage = DemonstrationMaker::Stage;

constexpr const char* kPlayed = R"({"passed": true,
  "assessment": {"steps": [{"name": "Survey", "done": true, "at_s": 2}, {"name": "Cut", "done": true, "at_s": 5}],
                 "errors": []},
  "surgeon": {"performed": [{"tick": 0, "goal": "look around", "skill": "move the endoscope"},
                            {"tick": 2100, "goal": "cut the tube", "skill": "close"},
                            {"tick": "x"}, 7]}})";

TEST(Captions, ShowTheStepItsHintAndWhatIsPerformed) {
  training::Steps steps(2);
  steps[0].hint = "turn the endoscope";
  steps[1].hint = "cut between the clips";
  const Captions captions(kPlayed, steps);
  EXPECT_EQ(captions.at(100), (Caption{"Survey", "turn the endoscope", "Look around: move the endoscope"}));
  EXPECT_EQ(captions.at(3000), (Caption{"Cut", "cut between the clips", "Cut the tube: close"}));
  EXPECT_EQ(captions.at(6000).step, "") << "all steps are completed";
}

TEST(Captions, OfAnAttemptHaveNoSkill) {
  const Captions captions(R"({"assessment": {"steps": [{"name": "Survey", "done": false}]}})", training::Steps(1));
  EXPECT_EQ(captions.at(500), (Caption{"Survey", "", ""}));
  EXPECT_TRUE(Captions("", {}).empty());
  EXPECT_TRUE(Captions("[7]", {}).empty());
}

TEST(Marks, OfOneKindAreFoundAlone) {
  using Kind = TimelineMark::Kind;
  const std::vector<TimelineMark> marks{
      {Kind::event, 10, ""}, {Kind::step, 20, ""}, {Kind::error, 30, ""}, {Kind::step, 40, ""}};
  EXPECT_EQ(next_mark(marks, 0, Kind::step)->tick, 20u);
  EXPECT_EQ(next_mark(marks, 20, Kind::step)->tick, 40u);
  EXPECT_EQ(next_mark(marks, 40, Kind::step), nullptr);
  EXPECT_EQ(previous_mark(marks, 40, Kind::step)->tick, 20u);
  EXPECT_EQ(previous_mark(marks, 20, Kind::step), nullptr);
}

TEST(ExerciseHash, ChangesWithALimitAndNotWithLayout) {
  const fs::path file = find_exercise("basics/camera-0", scenes_folder());
  std::ifstream in(file);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  const auto hash = [&](const std::string& changed) {
    const scene::MemoryFiles memory{{file.string(), changed}};
    return training::hash_of(training::read_exercise(file, &memory));
  };
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    return changed;
  };
  EXPECT_EQ(hash(text), hash("// a comment\n" + text));
  EXPECT_NE(hash(text), hash(with("\"value\": 0.1", "\"value\": 0.11")));
  EXPECT_NE(hash(text), hash(with("\"from_mm\": 50", "\"from_mm\": 51"))) << "the demonstration";
}

/// A data folder of its own.
class KeptDemonstration : public testing::Test {
 protected:
  void SetUp() override {
    m_folder = fs::temp_directory_path() / ("trocar-playback-" + std::to_string(::getpid()));
    fs::remove_all(m_folder);
    setenv("TROCAR_DATA", m_folder.c_str(), 1);
  }
  void TearDown() override {
    unsetenv("TROCAR_DATA");
    fs::remove_all(m_folder);
  }
  static DemonstrationMaker::Progress wait(const DemonstrationMaker& maker) {
    while (maker.busy()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return maker.progress();
  }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    std::error_code none;
    for (const auto& f : fs::directory_iterator(m_folder / "demonstrations", none))
      names.push_back(f.path().filename().string());
    return names;
  }
  fs::path m_folder;
};

TEST_F(KeptDemonstration, IsRecordedOnceAndFoundAgain) {
  const std::unique_ptr<Lesson> lesson = load_lesson("basics/camera-0", 3);
  EXPECT_FALSE(kept_demonstration(*lesson));
  DemonstrationMaker maker;
  maker.start("basics/camera-0", 3);
  const auto p = wait(maker);
  ASSERT_EQ(p.stage, Stage::done) << p.failure;
  EXPECT_TRUE(p.passed);
  EXPECT_EQ(p.share(), 1);
  EXPECT_EQ(kept_demonstration(*lesson), p.file);
  const sim::Recording recording = sim::read_recording(p.file.string());
  EXPECT_TRUE(recording.complete);
  EXPECT_EQ(recording.header.seed, 3u);
  EXPECT_FALSE(doings_of_result(recording.result_json).empty());
  EXPECT_EQ(files().size(), 1u);
}

TEST_F(KeptDemonstration, OfAChangedExerciseIsAnother) {
  const std::unique_ptr<Lesson> lesson = load_lesson("basics/camera-0", 3);
  const std::uint64_t key = demonstration_key(*lesson);
  const fs::path old = demonstration_path(*lesson);
  fs::create_directories(old.parent_path());
  std::ofstream(old) << "an outdated one";
  lesson->exercise->pass_mark = 81;
  EXPECT_NE(demonstration_key(*lesson), key);
  EXPECT_FALSE(kept_demonstration(*lesson));
  std::ofstream(m_folder / "new.rec") << "a new one";
  keep_demonstration(*lesson, m_folder / "new.rec");
  EXPECT_EQ(files(), (std::vector<std::string>{demonstration_path(*lesson).filename().string()}));
  lesson->exercise->pass_mark = 80;
  lesson->model.hash += 1;
  EXPECT_NE(demonstration_key(*lesson), key);
}

TEST_F(KeptDemonstration, WhatIsDamagedIsNotPlayed) {
  const std::unique_ptr<Lesson> lesson = load_lesson("basics/camera-0", 3);
  const fs::path file = demonstration_path(*lesson);
  fs::create_directories(file.parent_path());
  std::ofstream(file) << "half a recording";
  EXPECT_FALSE(kept_demonstration(*lesson));
}

TEST_F(KeptDemonstration, ThatIsCancelledOrFailsLeavesNoFile) {
  {
    DemonstrationMaker maker;
    maker.start("basics/camera-0", 4);
    while (maker.progress().seconds < 0.5 && maker.busy()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    maker.cancel();
    EXPECT_EQ(maker.progress().stage, Stage::cancelled);
  }
  EXPECT_TRUE(files().empty());
  DemonstrationMaker maker;
  maker.start("no/such-exercise", 0);
  const auto p = wait(maker);
  EXPECT_EQ(p.stage, Stage::failed);
  EXPECT_FALSE(p.failure.empty());
  EXPECT_TRUE(files().empty());
}

TEST(DemonstrationProgress, StaysBelowOneUntilItIsDone) {
  DemonstrationMaker::Progress p;
  EXPECT_EQ(p.share(), 0);
  p.stage = Stage::recording;
  p.expected = 60;
  p.seconds = 15;
  EXPECT_EQ(p.share(), 0.25);
  p.seconds = 90;
  EXPECT_LT(p.share(), 1);
  EXPECT_TRUE(reached_pass_mark(R"({"passed": true})"));
  EXPECT_FALSE(reached_pass_mark(R"({"passed": null})"));
  EXPECT_FALSE(reached_pass_mark(""));
}

}  // namespace
}  // namespace trocar::attempt
