// The box at a port: a pseudo-terminal with a software box behind it, plugged in and out.
#include <atomic>
#include <filesystem>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include <trocar/core/error.hpp>
#include <trocar/devices/box/box_thread.hpp>
#include <trocar/devices/box/serving.hpp>

namespace trocar::devices {
namespace {

using namespace std::chrono_literals;

BoxBlock still(double) {
  BoxBlock block;
  block.codes.fill(2048);
  return block;
}

/// A software box on a thread of its own, until it goes out of scope.
struct Plugged {
  explicit Plugged(const std::string& link, const SoftwareBoxSettings& settings = {},
                   SoftwareBox::Motion motion = still)
      : terminal(link),
        box(settings, std::move(motion)),
        thread([this] { serve(box, terminal, [this] { return stop.load(); }); }) {}
  ~Plugged() {
    stop = true;
    thread.join();
  }
  PseudoTerminal terminal;
  SoftwareBox box;
  std::atomic<bool> stop{false};
  std::thread thread;
};

class BoxPort : public testing::Test {
 protected:
  void SetUp() override {
    if (!PseudoTerminal::possible()) GTEST_SKIP() << "/dev/ptmx is missing: no pseudo-terminals here";
    folder = std::filesystem::temp_directory_path() / ("trocar_box_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    port = (folder / "box").string();
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  /// Waits for a pose of a block beyond `number`.
  static bool newer(BoxThread& box, BoxPose& pose, std::uint64_t number = 0) {
    for (int i = 0; i < 2000; ++i) {
      if (box.take(pose) && pose.number > number) return true;
      std::this_thread::sleep_for(5ms);
    }
    return false;
  }

  std::filesystem::path folder;
  std::string port;
};

TEST_F(BoxPort, WhatTheBoxMeasuresArrives) {
  Plugged plugged(port, {}, [](double seconds) {
    BoxBlock block = still(seconds);
    block.codes[3] = 3686;
    block.digital = 1;
    return block;
  });
  BoxThread box(port, default_wiring());
  BoxPose pose;
  ASSERT_TRUE(newer(box, pose, 10));
  EXPECT_NEAR(pose.of(BoxActor::left, BoxAxis::depth), 0.3, 1e-3);
  EXPECT_EQ(pose.pedals, std::uint32_t(kBoxCoagulate));
  EXPECT_EQ(pose.wired, (1u << 25) - 1);
  EXPECT_EQ(box.status().counts.bad, 0u);
}

TEST_F(BoxPort, RawBlocksArriveToo) {
  BoxWiring wiring = default_wiring();
  wiring.raw = true;
  Plugged plugged(port, {.raw = true});
  BoxThread box(port, wiring);
  BoxPose pose;
  ASSERT_TRUE(newer(box, pose, 20));
  EXPECT_EQ(pose.block, still(0));
}

TEST_F(BoxPort, NothingIsEchoedToTheBox) {
  PseudoTerminal terminal(port);
  SerialPort host = SerialPort::open(port, 38'400);
  const std::uint8_t sent[] = {0xa5, '\r', '\n', 0x03, 0x11, 0x13, 0x04, 0x7f};
  terminal.write(sent);
  std::array<std::uint8_t, 64> got{};
  ASSERT_TRUE(host.wait(box_now() + 2'000'000'000));
  std::this_thread::sleep_for(20ms);
  ASSERT_EQ(host.read(got), 8) << "every byte, as it is";
  EXPECT_TRUE(std::equal(std::begin(sent), std::end(sent), got.begin()));
  EXPECT_EQ(terminal.read(got), 0);
}

TEST_F(BoxPort, UnpluggedAndPluggedInAgainItGoesOn) {
  auto plugged = std::make_unique<Plugged>(port);
  BoxThread box(port, default_wiring());
  BoxPose pose;
  ASSERT_TRUE(newer(box, pose, 5));
  plugged.reset();
  for (int i = 0; i < 1000 && box.status().open; ++i) std::this_thread::sleep_for(5ms);
  EXPECT_FALSE(box.status().open);
  EXPECT_FALSE(std::filesystem::exists(port)) << "the link is taken away with it";
  while (box.take(pose)) {
  }
  const std::uint64_t before = pose.number;
  plugged = std::make_unique<Plugged>(port);
  EXPECT_TRUE(newer(box, pose, before + 5));
  EXPECT_TRUE(box.status().open);
  EXPECT_GE(box.status().opened, 2u);
  EXPECT_EQ(pose.wired, (1u << 25) - 1) << "it was told its channels anew";
}

TEST_F(BoxPort, WhoServesIsToldWhenTheReaderStopsComesBackAndGoes) {
  PseudoTerminal terminal(port);
  SoftwareBox box({}, still);
  std::mutex lock;
  std::vector<PortReader> told;
  std::atomic<bool> stop{false};
  std::thread server([&] {
    serve(
        box, terminal, [&] { return stop.load(); },
        [&](PortReader reader) {
          const std::lock_guard guard(lock);
          told.push_back(reader);
        });
  });
  {
    SerialPort host = SerialPort::open(port, 38'400);
    std::array<std::uint8_t, kPollBytes> poll{};
    write_poll(1, poll);
    host.write(poll);
    std::this_thread::sleep_for(800ms);
    write_poll(2, poll);
    host.write(poll);
    std::this_thread::sleep_for(100ms);
  }
  std::this_thread::sleep_for(200ms);
  stop = true;
  server.join();
  EXPECT_EQ(told, (std::vector<PortReader>{PortReader::asks, PortReader::stopped, PortReader::asks, PortReader::none}));
}

TEST_F(BoxPort, AHostThatComesBackFindsTheBox) {
  Plugged plugged(port);
  for (int round = 0; round < 3; ++round) {
    BoxThread box(port, default_wiring());
    BoxPose pose;
    EXPECT_TRUE(newer(box, pose, 3)) << round;
  }
}

TEST_F(BoxPort, APortThatIsNotThereSaysWhatToDo) {
  try {
    BoxThread box(port, default_wiring());
    FAIL() << "it was opened";
  } catch (const core::EnvironmentLacks& lacks) {
    EXPECT_NE(std::string(lacks.what()).find("box simulate"), std::string::npos) << lacks.what();
  }
  std::filesystem::path file = folder / "file";
  std::fclose(std::fopen(file.c_str(), "w"));
  EXPECT_THROW(SerialPort::open(file.string(), 38'400), core::EnvironmentLacks);
  EXPECT_THROW(PseudoTerminal{file.string()}, core::BadInput) << "a file of somebody's is not replaced by a link";
}

}  // namespace
}  // namespace trocar::devices
