// The hepatocystic triangle dissected, and a slit stitched, by who has one gamepad, and by who has mouse and keyboard:
// both hands at once.
#include <gtest/gtest.h>

#include "device_robot.hpp"

namespace trocar::attempt::robots {
namespace {

constexpr double kLongest = 1200;  // [s]

template <class Fingers>
void dissects() {
  const Done done = do_with<Fingers>("cholecystectomy/calot", kLongest);
  EXPECT_TRUE(done.finished);
  EXPECT_TRUE(done.score.passed) << done.score.total;
  EXPECT_EQ(done.account.exchanges, 2);
  EXPECT_GT(done.account.share(done.account.both), 1) << "[%] of the ticks";
}

TEST(DeviceRobot, DissectsTheTriangleWithOneGamepadBothHandsAtOnce) { dissects<PadFingers>(); }

TEST(DeviceRobot, DissectsTheTriangleWithMouseAndKeyboardBothHandsAtOnce) { dissects<MouseAndKeysFingers>(); }

template <class Fingers>
void stitches() {
  const Done done = do_with<Fingers>("suturing/needle-through", kLongest);
  EXPECT_TRUE(done.finished);
  EXPECT_TRUE(done.score.passed) << done.score.total;
}

TEST(DeviceRobot, DrivesANeedleThroughBothLipsWithOneGamepad) { stitches<PadFingers>(); }

TEST(DeviceRobot, DrivesANeedleThroughBothLipsWithMouseAndKeyboard) { stitches<MouseAndKeysFingers>(); }

TEST(DeviceRobot, SterilisesWithThreePadsInThreeRolesAtOneMachine) {
  const Done done = do_with<PadFingers>("gynaecology/sterilisation", kLongest, 0, false);
  EXPECT_TRUE(done.finished);
  EXPECT_TRUE(done.score.passed) << done.score.total;
  EXPECT_EQ(done.account.looks, 0) << "the operator never leads the endoscope";
}

}  // namespace
}  // namespace trocar::attempt::robots
