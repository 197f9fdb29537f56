// Ten minutes of fifty blocks a second at a port, in real time.
#include <algorithm>
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

TEST(BoxSoak, TenMinutesAtFiftyHertzLoseNothing) {
  if (!PseudoTerminal::possible()) GTEST_SKIP() << "/dev/ptmx is missing: no pseudo-terminals here";
  const std::string port =
      (std::filesystem::temp_directory_path() / ("trocar_box_minutes_" + std::to_string(getpid()))).string();
  PseudoTerminal terminal(port);
  SoftwareBox box({}, [](double) { return BoxBlock{}; });
  std::atomic<bool> stop{false};
  std::thread server([&] { serve(box, terminal, [&] { return stop.load(); }); });
  BoxStatus status;
  BoxTime longest = 0;
  {
    BoxThread host(port, default_wiring());
    for (int second = 0; second < 600; ++second) {
      std::this_thread::sleep_for(1s);
      status = host.status();
      longest = std::max(longest, status.longest_trip);
    }
  }
  stop = true;
  server.join();
  RecordProperty("blocks", std::to_string(status.counts.blocks));
  RecordProperty("longest_round_trip_ms", std::to_string(1000 * box_seconds(longest)));
  EXPECT_EQ(status.counts.missed, 0u);
  EXPECT_EQ(status.counts.bad + status.counts.skipped, 0u);
  EXPECT_EQ(status.opened, 1u);
  EXPECT_GT(status.counts.blocks, 29'000u);
}

}  // namespace
}  // namespace trocar::devices
