// Files of earlier versions stay readable. tests/data/formats_0_1_0/README.md says what they are.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/recording/recording.hpp>
#include <trocar/training/exercise/exercise.hpp>
#include <trocar/training/metrics/trace_csv.hpp>
#include <trocar/training/store/store.hpp>

#include "shell/settings.hpp"

namespace trocar::app {
namespace {

namespace fs = std::filesystem;

const fs::path kOld = TROCAR_SOURCE_DIR "/tests/data/formats_0_1_0";

TEST(Formats, ScenesAndOrgansOf010AreRead) {
  EXPECT_TRUE(scene::check_file(kOld / "scenes/small/scene.json").empty());
  EXPECT_TRUE(scene::check_file(kOld / "scenes/small/organ.json").empty());
  EXPECT_EQ(scene::read_scene(kOld / "scenes/small/scene.json").solids.at(0).name, "ball");
}

TEST(Formats, ExercisesOf010AreRead) {
  std::vector<core::Fault> faults;
  const training::Exercise exercise = training::read_exercise(kOld / "scenes/small/look.json", faults);
  for (const core::Fault& fault : faults) ADD_FAILURE() << core::to_string(fault);
  EXPECT_EQ(exercise.title, "Look at the ball");
  EXPECT_EQ(exercise.pass_mark, 80);
}

TEST(Formats, SettingsOf010AreRead) {
  std::vector<core::Fault> faults;
  const Settings settings = read_settings(kOld / "settings.json", faults);
  for (const core::Fault& fault : faults) ADD_FAILURE() << core::to_string(fault);
  EXPECT_EQ(settings.trainee, "Ada");
}

TEST(Formats, RecordingsOf010AreRead) {
  const sim::Recording recording = sim::read_recording(kOld / "attempt.rec");
  EXPECT_TRUE(recording.complete) << recording.damage;
  EXPECT_EQ(recording.header.program_version, "0.1.0");
  EXPECT_EQ(recording.inputs.size(), 300u);
  EXPECT_GE(recording.keyframes.size(), 3u);
}

TEST(Formats, MotionOf010IsRead) {
  std::ifstream in(kOld / "motion.csv");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_GE(training::trace_from_csv(text, "motion.csv").size(), 15u);
}

TEST(Formats, TheSessionStoreOf010IsRead) {
  const fs::path folder = fs::path(testing::TempDir()) / ("trocar_formats_" + std::to_string(getpid()));
  fs::create_directories(folder);
  fs::copy_file(kOld / "sessions.sqlite", folder / "sessions.sqlite");
  {
    const training::Store store(folder);
    for (const std::string& notice : store.notices()) ADD_FAILURE() << notice;
    const std::vector<training::Attempt> attempts = store.list();
    ASSERT_EQ(attempts.size(), 1u);
    EXPECT_EQ(attempts[0].trainee, "Ada");
    EXPECT_TRUE(attempts[0].has_trace);
    EXPECT_FALSE(store.find("1")->trace.empty());
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace trocar::app
