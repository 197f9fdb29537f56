// A device's loop beside the simulation of the gynaecology scene, in real time: what it holds of its thousand a second.
#include <cstdio>

#include <gtest/gtest.h>

#include <trocar/attempt/haptics/haptic_source.hpp>
#include <trocar/attempt/lesson.hpp>
#include <trocar/attempt/live.hpp>
#include <trocar/devices/haptics/simulated_device.hpp>

namespace trocar::attempt {
namespace {

TEST(HapticLoopBesideASimulation, ComputesEachForceWithinAMillisecondAndHoldsItsMeanRate) {
  constexpr std::uint64_t kTicks = 20'000;
  const std::unique_ptr<Lesson> lesson = load_lesson("gynaecology/sterilisation");
  Session session(*lesson);
  const std::unique_ptr<InputSource> surgeon = lesson->surgeon();
  HapticHand hand(lesson->model, haptic_hand_of(lesson->model, "", ""), std::make_unique<devices::SimulatedDevice>(),
                  HapticHand::Pace::own_loop, {});
  double slow = 0;
  {
    HapticSource felt(*surgeon, hand);
    Live live(session, felt, kTicks);
    while (!live.snapshot().finished) {
      std::this_thread::sleep_for(std::chrono::milliseconds(16));
      live.refresh();
    }
    live.stop();
    slow = live.slow_share();
  }
  const Json said = hand.describe();
  std::printf("    %s\n    slow motion in %.0f %% of the ticks\n", said.dump().c_str(), 100 * slow);
  EXPECT_LE(said["computing"]["p99.9_us"].get<double>(), 1000);
  const double periods = said["period"]["count"].get<double>(), missed = said["missed_periods"].get<double>();
  EXPECT_LT(missed, 0.02 * periods);
  EXPECT_NEAR(said["period"]["p50_us"].get<double>(), 1000, 50);
}

}  // namespace
}  // namespace trocar::attempt
