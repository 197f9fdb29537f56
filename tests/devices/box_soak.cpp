// Minutes of fifty blocks a second at a port, in real time: none is lost, and 99.9 % of them take at most 20 ms, from
// when the box has been asked until their last byte is here. The longest is reported.
#include <atomic>
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include <trocar/devices/box/box_thread.hpp>
#include <trocar/devices/box/serving.hpp>

namespace trocar::devices {
namespace {

using namespace std::chrono_literals;

constexpr ChannelMask kFortyFour = (ChannelMask(1) << 44) - 1;

/// Asks a software box for so long.
BoxStatus asked(const BoxWiring& wiring, ChannelMask mask, std::chrono::seconds time) {
  const std::string port =
      (std::filesystem::temp_directory_path() / ("trocar_box_minutes_" + std::to_string(getpid()))).string();
  PseudoTerminal terminal(port);
  SoftwareBox box({.raw = wiring.raw, .baud = wiring.baud}, [](double) { return BoxBlock{}; });
  std::atomic<bool> stop{false};
  std::thread server([&] { serve(box, terminal, [&] { return stop.load(); }); });
  BoxStatus status;
  {
    BoxThread host(port, wiring, mask);
    std::this_thread::sleep_for(time);
    status = host.status();
  }
  stop = true;
  server.join();
  return status;
}

void expect_on_time(const BoxStatus& status, std::chrono::seconds time, testing::Test& test) {
  test.RecordProperty("blocks", std::to_string(status.counts.blocks));
  test.RecordProperty("round_trip_p999_ms", std::to_string(1000 * status.trip_p999));
  test.RecordProperty("longest_round_trip_ms", std::to_string(1000 * status.trip_most));
  std::printf("    %llu blocks, 99.9 %% within %.2f ms, longest %.2f ms\n",
              static_cast<unsigned long long>(status.counts.blocks), 1000 * status.trip_p999, 1000 * status.trip_most);
  EXPECT_EQ(status.counts.missed, 0u);
  EXPECT_EQ(status.counts.bad + status.counts.skipped, 0u);
  EXPECT_EQ(status.opened, 1u);
  EXPECT_GT(double(status.counts.blocks), 0.97 * 50 * double(time.count()));
  EXPECT_LE(status.trip_p999, 0.020);
}

class BoxSoak : public testing::Test {
 protected:
  void SetUp() override {
    if (!PseudoTerminal::possible()) GTEST_SKIP() << "/dev/ptmx is missing: no pseudo-terminals here";
  }
};

TEST_F(BoxSoak, TenMinutesAtFiftyHertzLoseNothing) {
  const BoxWiring& wiring = default_wiring();
  expect_on_time(asked(wiring, wiring.mask(), 600s), 600s, *this);
}

TEST_F(BoxSoak, AsManyChannelsAsFramesCarryAt38400BaudTakeAtMostTwentyMilliseconds) {
  expect_on_time(asked(default_wiring(), kFortyFour, 120s), 120s, *this);
}

TEST_F(BoxSoak, AllChannelsRawAt38400BaudTakeAtMostTwentyMilliseconds) {
  BoxWiring wiring = default_wiring();
  wiring.raw = true;
  expect_on_time(asked(wiring, kAllBoxChannels, 120s), 120s, *this);
}

TEST_F(BoxSoak, AllChannelsInFramesAt57600BaudTakeAtMostTwentyMilliseconds) {
  BoxWiring wiring = default_wiring();
  wiring.baud = 57'600;
  expect_on_time(asked(wiring, kAllBoxChannels, 120s), 120s, *this);
}

}  // namespace
}  // namespace trocar::devices
