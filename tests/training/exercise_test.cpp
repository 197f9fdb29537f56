// The exercise file: what is read, and that every fault of it is found and located.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>

#include <gtest/gtest.h>
#include <unistd.h>

#include <trocar/training/exercise/exercise.hpp>

using namespace trocar;
using namespace trocar::training;
namespace fs = std::filesystem;

namespace {

const char* const kShipped = TROCAR_SOURCE_DIR "/scenes/gynaecology/sterilisation.json";

class ExerciseFile : public testing::Test {
 protected:
  ExerciseFile() {
    fs::create_directories(m_folder);
    std::ifstream in(kShipped);
    m_text.assign(std::istreambuf_iterator<char>(in), {});
  }
  ~ExerciseFile() override { fs::remove_all(m_folder); }

  /// Replaces the first occurrence of `from` and notes its line.
  void change(const std::string& from, const std::string& to) {
    const size_t at = m_text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    m_line = 1 + int(std::count(m_text.begin(), m_text.begin() + std::ptrdiff_t(at), '\n'));
    m_text.replace(at, from.size(), to);
  }
  std::vector<core::Fault> faults() {
    const fs::path path = m_folder / "exercise.json";
    std::ofstream(path) << m_text;
    try {
      read_exercise(path);
    } catch (const core::BadInput& bad) {
      for (const core::Fault& f : bad.faults()) EXPECT_EQ(f.at.file, path.string());
      return bad.faults();
    }
    return {};
  }
  void expect_one_fault(const std::string& saying) {
    const std::vector<core::Fault> found = faults();
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].at.line, m_line) << to_string(found[0]);
    EXPECT_GT(found[0].at.column, 0);
    EXPECT_NE(found[0].message.find(saying), std::string::npos) << found[0].message;
  }

  std::string m_text;
  int m_line = 0;

 private:
  fs::path m_folder = fs::path(testing::TempDir()) / ("trocar_exercise_" + std::to_string(::getpid()));
};

TEST_F(ExerciseFile, AsShippedItIsReadInMetresRadiansAndSeconds) {
  EXPECT_TRUE(faults().empty());
  const Exercise e = read_exercise(kShipped);
  EXPECT_EQ(e.name, "sterilisation");
  ASSERT_EQ(e.goal.sides.size(), 2u);
  EXPECT_EQ(e.goal.sides[0].tube, "tube_left");
  EXPECT_EQ(e.goal.sides[1].ovary, "ovary_right");
  EXPECT_TRUE(fs::exists(e.scene)) << e.scene;
  EXPECT_DOUBLE_EQ(e.goal.first_clip.low, 0.012);
  EXPECT_DOUBLE_EQ(e.goal.first_clip.high, 0.020);
  EXPECT_NEAR(e.goal.clip_angle, 15 * std::numbers::pi / 180, 1e-12);
  EXPECT_DOUBLE_EQ(e.goal.cut_margin, 0.002);
  EXPECT_DOUBLE_EQ(e.goal.pull_limit, 4);
  EXPECT_DOUBLE_EQ(e.goal.present_pull.low, 0.3);
  EXPECT_EQ(e.text(Task::second_clip).name, "second_clip");
  EXPECT_FALSE(e.text(Task::second_clip).hint.empty());
  ASSERT_NE(e.penalty("E11"), nullptr);
  EXPECT_TRUE(e.penalty("E11")->fail);
  EXPECT_EQ(e.penalty("E99"), nullptr);
}

TEST_F(ExerciseFile, AMissingKeyIsLocated) {
  change("\"pass_mark\": 80,", "");
  const auto found = faults();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].message.find("pass_mark"), std::string::npos) << found[0].message;
  EXPECT_GT(found[0].at.line, 0);
}

TEST_F(ExerciseFile, AnUnknownKeyIsLocated) {
  change("\"hold_s\": 0.2,", "\"hold_s\": 0.2, \"hold_ms\": 200,");
  expect_one_fault("hold_ms");
}

TEST_F(ExerciseFile, AWrongTypeIsLocated) {
  change("\"pull_limit_N\": {\"value\": 4", "\"pull_limit_N\": {\"value\": \"four\"");
  expect_one_fault("expected");
}

TEST_F(ExerciseFile, AThresholdBeyondWhatItCanBeIsLocated) {
  change("\"clip_angle_deg\": {\"value\": 15", "\"clip_angle_deg\": {\"value\": 150");
  expect_one_fault("clip_angle_deg");
}

TEST_F(ExerciseFile, AThresholdWithoutASourceIsLocated) {
  change("\"cut_fraction\": {\"value\": 0.99, \"source\": \"ours\"}", "\"cut_fraction\": {\"value\": 0.99}");
  expect_one_fault("source");
}

TEST_F(ExerciseFile, EveryThresholdSaysWhereItComesFrom) {
  const Exercise e = read_exercise(kShipped);
  ASSERT_EQ(e.threshold_sources.size(), thresholds(Exercise::Kind::sterilisation).size());
  for (size_t i = 0; i < thresholds(Exercise::Kind::sterilisation).size(); ++i)
    EXPECT_FALSE(e.threshold_sources[i].empty()) << thresholds(Exercise::Kind::sterilisation)[i].key;
}

TEST_F(ExerciseFile, TheSameTubeOnBothSidesIsLocated) {
  change("\"tube\": \"tube_right\"", "\"tube\": \"tube_left\"");
  expect_one_fault("another tube");
}

TEST_F(ExerciseFile, AStepThatIsMissingOrUnknownIsLocated) {
  change("\"step\": \"check\"", "\"step\": \"chek\"");
  const auto found = faults();
  ASSERT_GE(found.size(), 1u);
  EXPECT_NE(found[0].message.find("chek"), std::string::npos) << found[0].message;
}

TEST_F(ExerciseFile, AnErrorThatImpliesAnUnknownOneIsLocated) {
  change("\"may\": [\"E3\"]", "\"may\": [\"E33\"]");
  expect_one_fault("E33");
}

TEST_F(ExerciseFile, AnUnknownKindIsLocated) {
  change("\"kind\": \"sterilisation\"", "\"kind\": \"appendectomy\"");
  expect_one_fault("appendectomy");
}

TEST_F(ExerciseFile, AnEmptyIntervalIsLocated) {
  change("\"first_clip_mm\": {\"from\": 12", "\"first_clip_mm\": {\"from\": 22");
  expect_one_fault("expected from <= to");
}

TEST_F(ExerciseFile, TimesThatLeaveNothingInBetweenAreLocated) {
  change("\"longest_s\": 900", "\"longest_s\": 240");
  expect_one_fault("expert_s");
}

TEST_F(ExerciseFile, ANumberOutOfRangeIsLocated) {
  change("\"pass_mark\": 80", "\"pass_mark\": 800");
  expect_one_fault("expected");
}

TEST_F(ExerciseFile, AllFaultsAreFoundInOnePass) {
  change("\"pass_mark\": 80", "\"pass_mark\": 800");
  change("\"kind\": \"sterilisation\"", "\"kind\": \"appendectomy\"");
  change("\"clip_cover\": {\"value\": 0.98", "\"clip_cover\": {\"value\": \"whole\"");
  EXPECT_EQ(faults().size(), 3u);
}

TEST_F(ExerciseFile, AFileThatIsNotThereIsSaid) {
  EXPECT_THROW(read_exercise("/nowhere/exercise.json"), core::BadInput);
}

TEST_F(ExerciseFile, TornAnywhereItIsAFaultAndNotACrash) {
  const std::string whole = m_text;
  for (size_t n = 0; n + 3 < whole.size(); n += 97) {
    m_text = whole.substr(0, n);
    EXPECT_FALSE(faults().empty()) << "after " << n << " bytes";
  }
}

}  // namespace
