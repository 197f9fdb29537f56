// What an attempt leaves on the disk when not everything there is as it should be.
#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <trocar/attempt/attempt_log.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/log.hpp>

#include "../other_process.hpp"
#include "../sim/small_scene.hpp"

namespace trocar::attempt {
namespace {

namespace fs = std::filesystem;

const attempt::Lesson& lesson() {
  static const auto made = [] {
    auto l = std::make_unique<attempt::Lesson>();
    l->name = "small";
    l->model = small::model();
    return l;
  }();
  return *made;
}

class AttemptLogTest : public testing::Test {
 protected:
  void SetUp() override {
    core::log::set_level(core::log::Level::off);
    m_root = fs::temp_directory_path() / ("trocar_attempt_log_test_" + std::to_string(getpid()) + "_" +
                                          testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(m_root / "tmp");
    for (const fs::path& open : {m_root, m_root / "tmp"}) fs::permissions(open, fs::perms::all);
    setenv("TMPDIR", (m_root / "tmp").c_str(), 1);
  }
  void TearDown() override {
    unsetenv("TMPDIR");
    core::log::set_level(core::log::Level::info);
    std::error_code ignored;
    fs::remove_all(m_root, ignored);
  }
  fs::path data() const { return m_root / "data"; }
  fs::path root() const { return m_root; }

  /// A folder in which nobody but root can make files.
  static void make_read_only(const fs::path& folder) {
    fs::create_directories(folder);
    chmod(folder.c_str(), 0555);
  }
  /// Ten ticks; what is said of them.
  static Json attempt(training::Store& store, const attempt::AttemptPlan& plan) {
    attempt::Session session(lesson(), 1);
    attempt::AttemptLog log(&store, session, plan);
    for (int i = 0; i < 10; ++i) session.advance(lesson().model.start);
    Json result = session.result(false);
    log.end(result, training::AttemptState::finished);
    return result;
  }

 private:
  fs::path m_root;
};

TEST_F(AttemptLogTest, WhereTheDataFolderCannotBeWrittenNothingIsLostAndTheNextOpeningFindsIt) {
  make_read_only(data());
  const int failed = test::elsewhere([&] {
    if (!test::become_nobody()) return 77;
    Json result;
    {
      training::Store store(data());
      result = attempt(store, {});
    }
    const fs::path recording = result.value("recording", "");
    if (recording.parent_path() != training::own_temporary_folder()) return 1;
    fs::rename(data(), root() / "read-only");  // the same name, and now it can be written
    const training::Store again(data());
    const std::optional<training::Attempt> a = again.find(result["attempt"]["uuid"]);
    return a && a->ticks == 10 && !a->trace.empty() && a->recording == recording ? 0 : 2;
  });
  if (failed == 77) GTEST_SKIP() << "cannot give up root's rights here";
  EXPECT_EQ(failed, 0) << "1: the recording is not in the user's own temporary folder; 2: the result was not taken in";
}

TEST_F(AttemptLogTest, OfABareSceneIsFreePracticeAndNotAFailedAttempt) {
  training::Store store(data());
  static_cast<void>(attempt(store, {}));
  const std::vector<training::Attempt> kept = store.list();
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(kept[0].mode, training::AttemptMode::free_practice);
  EXPECT_FALSE(kept[0].score || kept[0].passed);
}

TEST_F(AttemptLogTest, WithoutTheRecordingThatWasAskedForTheAttemptNeverBegan) {
  training::Store store(data());
  attempt::AttemptPlan plan;
  plan.recording = "/proc/nowhere/a.rec";
  EXPECT_THROW(attempt(store, plan), core::EnvironmentLacks);
  EXPECT_TRUE(store.list().empty());
  EXPECT_TRUE(fs::is_empty(data() / "locks"));
}

TEST_F(AttemptLogTest, AnOlderRecordingThatCannotBeKeptIsNotWrittenOver) {
  const fs::path folder = root() / "kept", file = folder / "a.rec";
  fs::create_directories(folder);
  std::ofstream(file) << "somebody's work";
  fs::permissions(file, fs::perms::all);
  make_read_only(folder);
  const int failed = test::elsewhere([&] {
    if (!test::become_nobody()) return 77;
    training::Store store(data());
    attempt::AttemptPlan plan;
    plan.recording = file;
    try {
      attempt(store, plan);
    } catch (const core::EnvironmentLacks&) {
      return 0;
    }
    return 1;
  });
  if (failed == 77) GTEST_SKIP() << "cannot give up root's rights here";
  EXPECT_EQ(failed, 0);
  std::ifstream in(file);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), "somebody's work");
}

TEST_F(AttemptLogTest, AStrangersFolderInTheTemporaryOneIsNotWrittenTo) {
  make_read_only(data());
  fs::create_directories(root() / "elsewhere");
  fs::permissions(root() / "elsewhere", fs::perms::all);
  for (const char* name : {"trocar-65534", "trocar-recordings-65534"})
    fs::create_directory_symlink(root() / "elsewhere", root() / "tmp" / name);
  const int failed = test::elsewhere([&] {
    if (!test::become_nobody()) return 77;
    training::Store store(data());
    const Json result = attempt(store, {});
    return fs::is_empty(root() / "elsewhere") ? 0 : 1;
  });
  if (failed == 77) GTEST_SKIP() << "cannot give up root's rights here";
  EXPECT_EQ(failed, 0);
}

}  // namespace
}  // namespace trocar::attempt
