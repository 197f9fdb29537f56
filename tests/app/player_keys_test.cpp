// What a gamepad asks of the player.
#include "player/player_keys.hpp"

#include <gtest/gtest.h>

#include <trocar/attempt/timeline.hpp>

namespace trocar::app {
namespace {

TEST(PadReader, AButtonCountsOnceAndAHeldCrossRepeats) {
  PadReader reader;
  devices::Gamepad pad;
  pad.set(devices::Button::a);
  pad.set(devices::Button::right);
  int toggles = 0, ticks = 0;
  for (int i = 0; i < 60; ++i) {  // a second at 60 pictures
    PlayerCommands c;
    reader.read(pad, 1.0 / 60, c);
    toggles += c.toggle_play;
    ticks += c.ticks;
  }
  EXPECT_EQ(toggles, 1);
  EXPECT_GE(ticks, 6 * int(attempt::kFrameTicks));
  EXPECT_LE(ticks, 10 * int(attempt::kFrameTicks));
}

TEST(PadReader, ARestingStickDoesNothing) {
  PadReader reader;
  PlayerCommands c;
  devices::Gamepad pad;
  pad.left_x = 0.1f;
  pad.right_y = -0.12f;
  reader.read(pad, 0.1, c);
  EXPECT_EQ(c.scrub, 0);
  EXPECT_EQ(c.turn_pitch, 0);
  pad.left_x = 1;
  reader.read(pad, 0.1, c);
  EXPECT_GT(c.scrub, 0);
}

}  // namespace
}  // namespace trocar::app
