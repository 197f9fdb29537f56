// trocar box: the wiring in use as a file, a box of software that is looked at, and what is said where there is none.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include <trocar/core/error.hpp>
#include <trocar/devices/box/serving.hpp>

#include "run_program.hpp"

namespace trocar::app {
namespace {

namespace fs = std::filesystem;

class BoxCommand : public testing::Test {
 protected:
  void SetUp() override {
    m_folder = fs::temp_directory_path() / ("trocar_box_command_" + std::to_string(getpid()));
    fs::create_directories(m_folder);
    setenv("TROCAR_DATA", (m_folder / "data").c_str(), 1);
  }
  void TearDown() override { fs::remove_all(m_folder); }
  std::string file(const std::string& name) const { return (m_folder / name).string(); }

 private:
  fs::path m_folder;
};

TEST_F(BoxCommand, TheFileThatItWritesIsReadAndWrittenAsTheSame) {
  const Outcome built_in = trocar({"box", "file"});
  ASSERT_EQ(built_in.exit, core::kDone) << built_in.err;
  std::ofstream(file("box.json")) << built_in.out;
  EXPECT_EQ(trocar({"box", "file", "--wiring", file("box.json")}).out, built_in.out);
  std::ofstream(file("bad.json")) << "{\"format\": 1,\n \"rate_hz\": \"fast\"}";
  const Outcome bad = trocar({"box", "file", "--wiring", file("bad.json")});
  EXPECT_EQ(bad.exit, core::kBadInput);
  EXPECT_NE(bad.err.find("bad.json:2:13"), std::string::npos) << bad.err;
}

TEST_F(BoxCommand, WithoutABoxEveryCommandSaysWhatToDo) {
  const Outcome monitor = trocar({"box", "monitor", file("nothing")});
  EXPECT_EQ(monitor.exit, core::kEnvironment);
  EXPECT_NE(monitor.err.find("box simulate"), std::string::npos) << monitor.err;
  const Outcome train = trocar({"train", "cutting", "--input", "box:" + file("nothing"), "--headless", "--no-store"});
  EXPECT_EQ(train.exit, core::kEnvironment);
  EXPECT_NE(train.err.find("no port"), std::string::npos) << train.err;
  EXPECT_EQ(trocar({"box", "simulate", file("p"), "--wave", "--seconds", "1"}).exit, core::kBadInput)
      << "hands wave in a scene, and none was named";
}

TEST_F(BoxCommand, MonitorTellsWhatComesAsJsonLines) {
  if (!devices::PseudoTerminal::possible()) GTEST_SKIP() << "/dev/ptmx is missing: no pseudo-terminals here";
  devices::PseudoTerminal terminal(file("port"));
  devices::SoftwareBox box({}, [](double) {
    devices::BoxBlock block;
    block.codes.fill(1234);
    return block;
  });
  std::atomic<bool> stop{false};
  std::thread server([&] { devices::serve(box, terminal, [&] { return stop.load(); }); });
  const Outcome o = trocar({"box", "monitor", file("port"), "--json", "--seconds", "1"});
  stop = true;
  server.join();
  ASSERT_EQ(o.exit, core::kDone) << o.err;
  const std::string last = o.out.substr(o.out.rfind('\n', o.out.size() - 2) + 1);
  const Json line = Json::parse(last);
  EXPECT_GT(line["blocks"].get<int>(), 10);
  EXPECT_EQ(line["bad"], 0);
  EXPECT_EQ(line["codes"][24], 1234);
  EXPECT_EQ(line["codes"][25], 0) << "not wired, not asked for";
}

}  // namespace
}  // namespace trocar::app
