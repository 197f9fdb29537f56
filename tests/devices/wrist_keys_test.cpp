// A wrist by keys, mouse and gamepad.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/devices/both_hands.hpp>

namespace trocar::devices {
namespace {

HandSample picture() {
  HandSample s;
  s.dt = 1.0f / 60;
  return s;
}
HandState bending() {
  HandState state;
  state.wrist[0] = true;
  return state;
}

TEST(WristKeys, BendInThePicturesDirections) {
  const HandSettings settings;
  struct Case {
    Key key;
    float right, up;
  };
  for (const Case& c : {Case{Key::i, 0, 1}, {Key::m, 0, -1}, {Key::j, -1, 0}, {Key::l, 1, 0}}) {
    HandState state = bending();
    HandSample s = picture();
    s.held.set(c.key);
    const HandCommand command = lead(settings, s, state);
    EXPECT_NEAR(command.wrist.right, c.right * settings.bend_per_second / 60, 1e-6f) << name_of(c.key);
    EXPECT_NEAR(command.wrist.up, c.up * settings.bend_per_second / 60, 1e-6f) << name_of(c.key);
    EXPECT_EQ(command.tip.right, 0);
  }
}

TEST(WristKeys, StraightenWithO) {
  HandState state = bending();
  HandSample s = picture();
  s.pressed.set(Key::o);
  EXPECT_TRUE(lead({}, s, state).wrist.straighten);
}

TEST(WristKeys, DoNothingToARigidInstrument) {
  HandState state;
  HandSample s = picture();
  s.held.set(Key::i);
  s.held.set(Key::u);
  s.dx = 20;
  s.gamepad.set(Button::a);
  s.gamepad.right_x = 1;
  const HandCommand command = lead({}, s, state);
  EXPECT_EQ(command.wrist.up, 0);
  EXPECT_GT(command.tip.right, 0) << "the mouse is the tip's";
  EXPECT_GT(command.roll, 0) << "and the stick rolls";
  EXPECT_TRUE(command.blue) << "and A is the foot switch";
}

TEST(WristKeys, WithUHeldTheMouseBendsAndLeavesTheTip) {
  const HandSettings settings;
  HandState state = bending();
  HandSample s = picture();
  s.held.set(Key::u);
  s.dx = 20, s.dy = -10;
  HandCommand command = lead(settings, s, state);
  EXPECT_NEAR(command.wrist.right, 20 * settings.bend_per_pixel, 1e-5f);
  EXPECT_NEAR(command.wrist.up, 10 * settings.bend_per_pixel, 1e-5f);
  EXPECT_EQ(command.tip.right, 0);
  s.held.set(Key::shift);
  command = lead(settings, s, state);
  EXPECT_NEAR(command.wrist.right, settings.fine * 20 * settings.bend_per_pixel, 1e-5f);
}

TEST(WristKeys, WithAHeldTheRightStickBendsAndPressesNoFootSwitch) {
  const HandSettings settings;
  HandState state = bending();
  HandSample s = picture();
  s.gamepad.set(Button::a);
  s.gamepad.right_x = 1, s.gamepad.right_y = -1;
  const HandCommand command = lead(settings, s, state);
  EXPECT_NEAR(command.wrist.right, settings.stick_bend / 60, 1e-5f);
  EXPECT_NEAR(command.wrist.up, settings.stick_bend / 60, 1e-5f);
  EXPECT_EQ(command.roll, 0);
  EXPECT_EQ(command.tip.in, 0);
  EXPECT_FALSE(command.blue);
}

TEST(WristKeys, AxesOfAnotherDeviceBendWithoutAButton) {
  HandState state = bending();
  HandSample s = picture();
  s.gamepad.wrist_y = -1;
  EXPECT_GT(lead({}, s, state).wrist.up, 0);
}

TEST(WristKeys, BothHandsEachBendTheirOwn) {
  const HandSettings settings;
  BothHands hands;
  hands.state.wrist[1] = true;  // the right hand's
  lead_both(settings, true, hands);
  take_up(settings, picture(), hands);
  HandSample s = picture();
  lead(settings, s, hands);
  s.gamepad.set(Button::a);
  s.gamepad.left_x = s.gamepad.right_x = 1;
  for (const HandCommand& c : lead(settings, s, hands)) {
    if (c.led == 1) {
      EXPECT_GT(c.wrist.right, 0);
      EXPECT_EQ(c.tip.right, 0);
    } else {
      EXPECT_EQ(c.wrist.right, 0);
      EXPECT_GT(c.tip.right, 0) << "a rigid one goes on";
    }
  }
}

TEST(WristKeys, BrokenDevicesGiveNumbers) {
  HandState state = bending();
  HandSample s = picture();
  s.held.set(Key::u);
  s.dx = std::nanf(""), s.dy = INFINITY;
  s.gamepad.wrist_x = std::nanf("");
  const HandCommand command = lead({}, s, state);
  EXPECT_TRUE(std::isfinite(command.wrist.right));
  EXPECT_TRUE(std::isfinite(command.wrist.up));
}

}  // namespace
}  // namespace trocar::devices
