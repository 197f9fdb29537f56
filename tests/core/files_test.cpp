// Whole files: what is written is there at once or not at all, whoever writes beside.
#include <atomic>
#include <fstream>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>

using namespace trocar::core;
namespace fs = std::filesystem;

namespace {

class Files : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    m_folder = fs::path(testing::TempDir()) / ("trocar_files_" + std::string(info->name()));
    fs::remove_all(m_folder);
    fs::create_directories(m_folder);
  }
  void TearDown() override { fs::remove_all(m_folder); }

  fs::path in(const std::string& name) const { return m_folder / name; }
  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const auto& entry : fs::directory_iterator(m_folder)) out.push_back(entry.path().filename().string());
    return out;
  }
  static void leave(const fs::path& file, std::chrono::minutes old) {
    std::ofstream(file) << "half";
    fs::last_write_time(file, fs::file_time_type::clock::now() - old);
  }

  fs::path m_folder;
};

/// A process that has ended.
long gone_process() {
  const pid_t child = fork();
  if (child == 0) _exit(0);
  waitpid(child, nullptr, 0);
  return child;
}

}  // namespace

TEST_F(Files, PartsAreWrittenOneAfterTheOtherAndNothingElseIsLeft) {
  EXPECT_EQ(write_file(in("a"), {"one ", "two"}), "");
  EXPECT_EQ(read_file(in("a"), 100), "one two");
  EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

TEST_F(Files, ALinkIsReplacedAndWhatItLeadsToStays) {
  std::ofstream(in("other")) << "mine";
  fs::create_symlink(in("other"), in("a"));
  fs::create_symlink(in("other"), in("a.part"));
  EXPECT_EQ(write_file(in("a"), {"new"}), "");
  EXPECT_EQ(read_file(in("other"), 100), "mine");
  EXPECT_FALSE(fs::is_symlink(in("a")));
  EXPECT_EQ(read_file(in("a"), 100), "new");
}

TEST_F(Files, SeveralThatWriteOneFileAtOnceAllSucceedAndOneOfThemStays) {
  std::atomic<int> failed{0};
  std::vector<std::thread> writers;
  for (char c = 'a'; c < 'e'; ++c)
    writers.emplace_back([&, text = std::string(20'000, c)] {
      for (int i = 0; i < 20; ++i) failed += !write_file(in("shared"), {text}).empty();
    });
  for (std::thread& writer : writers) writer.join();
  EXPECT_EQ(failed, 0);
  const std::string text = read_file(in("shared"), 100'000);
  EXPECT_EQ(text, std::string(20'000, text.at(0)));
  EXPECT_EQ(names(), std::vector<std::string>{"shared"});
}

TEST_F(Files, WhatAnEndedProgramLeftUnfinishedGoesAndWhatALivingOneWritesStays) {
  using std::chrono::minutes;
  const std::string gone = std::to_string(gone_process()), mine = std::to_string(getpid());
  const std::string stale = "a." + gone + "-3.part", fresh = "a." + gone + "-4.part", living = "a." + mine + "-5.part",
                    another = "b." + gone + "-6.part", no_writer = "a.part", no_number = "a.-1-x.part";
  for (const std::string& name : {stale, living, another, no_writer, no_number}) leave(in(name), minutes(60));
  leave(in(fresh), minutes(1));
  EXPECT_EQ(write_file(in("a"), {"whole"}), "");
  EXPECT_FALSE(fs::exists(in(stale)));
  for (const std::string& name : {fresh, living, another, no_writer, no_number})
    EXPECT_TRUE(fs::exists(in(name))) << name;
  remove_unfinished(m_folder);
  EXPECT_FALSE(fs::exists(in(another)));
  EXPECT_TRUE(fs::exists(in(living)));
}

TEST_F(Files, AFileKeepsItsRightsAndANewOneHasThoseThatAreAsked) {
  EXPECT_EQ(write_file(in("own"), "x", 1, 0600), "");
  EXPECT_EQ(fs::status(in("own")).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  fs::permissions(in("own"), fs::perms::owner_all);
  EXPECT_EQ(write_file(in("own"), "y", 1, 0600), "");
  EXPECT_EQ(fs::status(in("own")).permissions(), fs::perms::owner_all);
}

TEST_F(Files, AFolderThatIsMissingIsMadeOrTheReasonIsTold) {
  put_file(in("new/deep/a"), "text");
  EXPECT_EQ(read_file(in("new/deep/a"), 100), "text");
  try {
    put_file(in("new/deep/a/b"), "text");
    FAIL();
  } catch (const BadInput& bad) {
    EXPECT_NE(std::string(bad.what()).find("a/b: expected a file that can be written, got \"Not a directory\""),
              std::string::npos)
        << bad.what();
  }
}
