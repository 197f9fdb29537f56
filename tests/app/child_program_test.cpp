// A program that is started beside the window: its texts, its exit status, and no zombie.
#include "shell/child_program.hpp"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include <trocar/core/error.hpp>

namespace trocar::app {
namespace {

int status_at_end(ChildProgram& child) {
  for (int i = 0; i < 500 && child.running(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return child.exit_status().value_or(-1);
}

TEST(ChildProgram, CollectsBothTextsAndTheExitStatus) {
  ChildProgram child({"-c", "echo out; echo \"$1\" >&2; exit 3", "sh", "two words"}, "/bin/sh");
  EXPECT_EQ(status_at_end(child), 3);
  EXPECT_TRUE(child.failed());
  EXPECT_EQ(child.output(), "out\n");
  EXPECT_EQ(child.errors(), "two words\n");
}

TEST(ChildProgram, SeesAddedVariablesBesideThoseOfThisProgram) {
  ChildProgram child({"-c", "echo $ADDED ${PATH:+path}"}, "/bin/sh", {"ADDED=one"});
  EXPECT_EQ(status_at_end(child), 0);
  EXPECT_EQ(child.output(), "one path\n");
}

// Not by a shell: one that is about to become another program may lose the signal.
TEST(ChildProgram, EndsWhenItIsAskedTo) {
  ChildProgram child({"20"}, "/bin/sleep");
  child.ask_to_end();
  EXPECT_EQ(status_at_end(child), 130);
}

TEST(ChildProgram, EndsWhenItIsAskedToBesideABackgroundProgram) {
  const auto before = std::signal(SIGINT, SIG_IGN);
  ChildProgram child({"20"}, "/bin/sleep");
  std::signal(SIGINT, before);
  child.ask_to_end();
  EXPECT_EQ(status_at_end(child), 130);
}

TEST(ChildProgram, ReportsTheSignalThatEndedIt) {
  ChildProgram child({"-c", "kill -9 $$"}, "/bin/sh");
  EXPECT_EQ(status_at_end(child), 137);
}

TEST(ChildProgram, KeepsTheEndOfALongText) {
  ChildProgram child({"-c", "i=0; while [ $i -lt 4000 ]; do echo line $i >&2; i=$((i+1)); done"}, "/bin/sh");
  EXPECT_EQ(status_at_end(child), 0);
  EXPECT_FALSE(child.failed());
  EXPECT_LE(child.errors().size(), 16u * 1024);
  EXPECT_NE(child.errors().find("line 3999"), std::string::npos);
}

TEST(ChildProgram, ThatIsNotThereIsReported) {
  try {
    ChildProgram child({"train"}, "/nowhere/trocar");
    EXPECT_EQ(status_at_end(child), 127);  // systems that find out only in the child
  } catch (const core::EnvironmentLacks& lacks) {
    EXPECT_NE(std::string(lacks.what()).find("could not be started"), std::string::npos);
  }
}

TEST(ChildProgram, GoesOnWhenTheWindowHasClosed) {
  const std::filesystem::path mark =
      std::filesystem::temp_directory_path() / ("trocar_child_" + std::to_string(::getpid()));
  {
    ChildProgram child({"-c", "sleep 0.2; echo late >&2 && : > \"$1\"", "sh", mark.string()}, "/bin/sh");
    ChildProgram moved = std::move(child);
    EXPECT_TRUE(moved.running());
  }
  for (int i = 0; i < 500 && !std::filesystem::exists(mark); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(std::filesystem::remove(mark));
}

}  // namespace
}  // namespace trocar::app
