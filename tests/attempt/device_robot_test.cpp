// The first seconds of what device_robot_soak.cpp does to its end: with either device the gallbladder is held, the hook
// goes to work, and both hands move in the same ticks.
#include "device_robot.hpp"

#include <gtest/gtest.h>

namespace trocar::attempt::robots {
namespace {

template <class Fingers>
void begins() {
  const Done done = do_with<Fingers>("cholecystectomy/calot", 16);
  EXPECT_EQ(done.steps_done, 1) << "the infundibulum is held";
  // a mouse that turns the endoscope leaves the other hand out of the picture for a while
  for (const std::string& code : done.errors) EXPECT_EQ(code, "E4.1");
  EXPECT_GT(done.account.looks, 0) << "the endoscope was led";
  EXPECT_GT(done.account.share(done.account.both), 0.5) << "[%] of the ticks: most of them are looking and holding";
}

TEST(DeviceRobot, HoldsTheGallbladderAndGoesToWorkWithOneGamepad) { begins<PadFingers>(); }

TEST(DeviceRobot, HoldsTheGallbladderAndGoesToWorkWithMouseAndKeyboard) { begins<MouseAndKeysFingers>(); }

}  // namespace
}  // namespace trocar::attempt::robots
