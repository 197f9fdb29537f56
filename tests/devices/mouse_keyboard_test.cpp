#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/devices/mouse_keyboard.hpp>

using namespace trocar::devices;

namespace {

constexpr float kDt = 1.0f / 60;

struct Session {
  HandSettings settings;
  HandState state;

  Session() { settings.instruments = 3; }
  HandCommand give(HandSample sample) {
    sample.dt = kDt;
    return lead(settings, sample, state);
  }
  void press(Key key) { give(with(key)); }
  void rest(int samples) {
    for (int i = 0; i < samples; ++i) give({});
  }
  void squeeze(int samples) {
    HandSample sample;
    sample.left_button = true;
    for (int i = 0; i < samples; ++i) give(sample);
  }
  static HandSample with(Key key) {
    HandSample sample;
    sample.pressed.set(key);
    return sample;
  }
  static HandSample holding(Key key) {
    HandSample sample;
    sample.held.set(key);
    return sample;
  }
  static HandSample moving(float dx, float dy) {
    HandSample sample;
    sample.dx = dx, sample.dy = dy;
    return sample;
  }
};

bool still(const HandCommand& c) {
  return c.tip.right == 0 && c.tip.up == 0 && c.tip.in == 0 && c.roll == 0 && c.scope.right == 0 && c.scope.up == 0 &&
         c.scope.in == 0 && c.scope.head == 0 && c.scope.post == 0;
}

}  // namespace

TEST(MouseKeyboard, NothingTouchedNothingMoves) {
  Session session;
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(still(session.give({})));
  EXPECT_EQ(session.state.handle, (std::array<float, kMaxHands>{}));
}

TEST(MouseKeyboard, NumbersTabAndScopeKeysChooseWhoIsLed) {
  Session session;
  EXPECT_EQ(session.give(Session::with(Key::three)).led, 2);
  EXPECT_EQ(session.give(Session::with(Key::one)).led, 0);
  EXPECT_EQ(session.give(Session::with(Key::tab)).led, 1);
  EXPECT_EQ(session.give(Session::with(Key::tab)).led, 2);
  EXPECT_EQ(session.give(Session::with(Key::tab)).led, 0);
  EXPECT_EQ(session.give(Session::with(Key::two)).led, 1);
  EXPECT_EQ(session.give(Session::with(Key::c)).led, kScope);
  EXPECT_EQ(session.give(Session::with(Key::tab)).led, 1);  // back to the one led before
  EXPECT_EQ(session.give(Session::with(Key::zero)).led, kScope);
  EXPECT_EQ(session.give(Session::with(Key::four)).led, kScope);  // there is no fourth
}

TEST(MouseKeyboard, MouseMovesTheTipInThePicture) {
  Session session;
  const HandCommand command = session.give(Session::moving(10, 4));
  EXPECT_FLOAT_EQ(command.tip.right, 10 * session.settings.metres_per_pixel);
  EXPECT_FLOAT_EQ(command.tip.up, -4 * session.settings.metres_per_pixel);
  EXPECT_EQ(command.tip.in, 0);
  EXPECT_EQ(command.roll, 0);
}

TEST(MouseKeyboard, WheelIsDepth) {
  Session session;
  HandSample sample;
  sample.wheel = -3;
  EXPECT_FLOAT_EQ(session.give(sample).tip.in, -3 * session.settings.metres_per_notch);
  session.press(Key::c);
  EXPECT_FLOAT_EQ(session.give(sample).scope.in, -3 * session.settings.metres_per_notch);
}

TEST(MouseKeyboard, RightDragAndKeysRollWithoutMovingTheTip) {
  Session session;
  HandSample drag = Session::moving(10, 5);
  drag.right_button = true;
  const HandCommand command = session.give(drag);
  EXPECT_FLOAT_EQ(command.roll, 10 * session.settings.roll_per_pixel);
  EXPECT_EQ(command.tip.right, 0);
  EXPECT_EQ(command.tip.up, 0);
  EXPECT_FLOAT_EQ(session.give(Session::holding(Key::e)).roll, kDt * session.settings.roll_per_second);
  EXPECT_FLOAT_EQ(session.give(Session::holding(Key::q)).roll, -kDt * session.settings.roll_per_second);
}

TEST(MouseKeyboard, ShiftQuartersEveryMotion) {
  Session plain, fine;
  HandSample sample = Session::moving(8, 8);
  sample.wheel = 1;
  sample.held.set(Key::e);
  const HandCommand full = plain.give(sample);
  sample.held.set(Key::shift);
  const HandCommand quarter = fine.give(sample);
  EXPECT_FLOAT_EQ(quarter.tip.right, full.tip.right / 4);
  EXPECT_FLOAT_EQ(quarter.tip.in, full.tip.in / 4);
  EXPECT_FLOAT_EQ(quarter.roll, full.roll / 4);
}

TEST(MouseKeyboard, HandleClosesProgressivelyAndOpensWhenReleased) {
  Session session;
  session.squeeze(6);
  EXPECT_NEAR(session.state.handle[0], 6 * kDt * session.settings.close_per_second, 1e-6);
  session.squeeze(100);
  EXPECT_EQ(session.state.handle[0], 1);
  session.rest(5);
  EXPECT_LT(session.state.handle[0], 1);
  EXPECT_GT(session.state.handle[0], 0);
  session.rest(60);
  EXPECT_EQ(session.state.handle[0], 0);
}

TEST(MouseKeyboard, RatchetHoldsTheGripUntilItIsReleased) {
  Session session;
  session.squeeze(10);
  session.press(Key::space);
  const float grip = session.state.handle[0];
  session.rest(100);
  EXPECT_EQ(session.state.handle[0], grip);
  session.press(Key::space);
  session.rest(100);
  EXPECT_EQ(session.state.handle[0], 0);
}

TEST(MouseKeyboard, AHandThatIsNotLedKeepsItsGripAndKeepsItWhenChosenAgain) {
  Session session;
  session.squeeze(60);
  HandSample change = Session::with(Key::two);
  change.left_button = true;  // still held: not meant for the second hand
  session.give(change);
  session.squeeze(20);
  session.rest(60);
  EXPECT_EQ(session.state.handle[0], 1);
  EXPECT_EQ(session.state.handle[1], 0);
  session.press(Key::one);
  session.rest(60);
  EXPECT_EQ(session.state.handle[0], 1);  // only a press and a release let go
  session.squeeze(1);
  session.rest(60);
  EXPECT_EQ(session.state.handle[0], 0);
}

TEST(MouseKeyboard, ScopeIsTurnedNotMoved) {
  Session session;
  session.press(Key::c);
  const HandCommand turned = session.give(Session::moving(10, -5));
  EXPECT_FLOAT_EQ(turned.scope.right, 10 * session.settings.view_per_pixel);
  EXPECT_FLOAT_EQ(turned.scope.up, 5 * session.settings.view_per_pixel);
  EXPECT_EQ(turned.tip.right, 0);
  EXPECT_FLOAT_EQ(session.give(Session::holding(Key::e)).scope.head, kDt * session.settings.roll_per_second);
  EXPECT_FLOAT_EQ(session.give(Session::holding(Key::r)).scope.post, kDt * session.settings.post_per_second);
  EXPECT_FLOAT_EQ(session.give(Session::holding(Key::f)).scope.post, -kDt * session.settings.post_per_second);
  session.squeeze(10);  // a scope has no handle
  EXPECT_EQ(session.state.handle, (std::array<float, kMaxHands>{}));
}

TEST(Gamepad, SticksMoveBeyondTheirRestZoneOnly) {
  Session session;
  HandSample sample;
  sample.gamepad.left_x = 0.1f, sample.gamepad.right_y = -0.1f;
  EXPECT_TRUE(still(session.give(sample)));
  sample.gamepad = {};
  sample.gamepad.left_x = 1, sample.gamepad.left_y = -1, sample.gamepad.right_y = -1, sample.gamepad.right_x = -1;
  const HandCommand command = session.give(sample);
  EXPECT_FLOAT_EQ(command.tip.right, kDt * session.settings.stick_speed);
  EXPECT_FLOAT_EQ(command.tip.up, kDt * session.settings.stick_speed);
  EXPECT_FLOAT_EQ(command.tip.in, kDt * session.settings.stick_speed);
  EXPECT_FLOAT_EQ(command.roll, -kDt * session.settings.stick_roll);
}

TEST(Gamepad, RightTriggerIsTheHandleLeftTriggerTheRatchet) {
  Session session;
  HandSample sample;
  sample.gamepad.right_trigger = 0.5f;
  for (int i = 0; i < 100; ++i) session.give(sample);
  EXPECT_EQ(session.state.handle[0], 0.5f);
  sample.gamepad.left_trigger = 1;
  for (int i = 0; i < 10; ++i) session.give(sample);  // one press, however long
  EXPECT_TRUE(session.state.ratchet[0]);
  session.rest(100);
  EXPECT_EQ(session.state.handle[0], 0.5f);
}

TEST(Gamepad, ShouldersGoRoundAllInstrumentsAndTheScope) {
  Session session;
  HandSample right, left;
  right.gamepad.right_shoulder = true;
  left.gamepad.left_shoulder = true;
  for (const int expected : {1, 2, kScope, 0}) {
    EXPECT_EQ(session.give(right).led, expected);
    EXPECT_EQ(session.give(right).led, expected);  // held is not pressed again
    session.rest(1);
  }
  EXPECT_EQ(session.give(left).led, kScope);
}

TEST(MouseKeyboard, InSpaceUsesThePicturesDirections) {
  const auto moved = in_space({1, 2, 3}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0});
  EXPECT_EQ(moved, (std::array<float, 3>{3, 1, 2}));
}

TEST(MouseKeyboard, ABrokenDeviceCannotBreakTheHand) {
  Session session;
  trocar::core::Random random(1);
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1e30f, 0, 1};
  const auto any = [&] { return bad[random.next() % 5]; };
  for (int i = 0; i < 10'000; ++i) {
    HandSample s;
    s.dt = any(), s.dx = std::isfinite(any()) ? 1.0f : bad[0], s.dy = bad[0], s.wheel = bad[1];
    s.left_button = random.next() & 1, s.right_button = random.next() & 1;
    s.gamepad = {any(), any(), any(), any(), any(), any(), bool(random.next() & 1), bool(random.next() & 1)};
    for (int key = 0; key < int(Key::count); ++key) s.held.set(Key(key), random.next() & 1);
    for (int key = 0; key < int(Key::count); ++key) s.pressed.set(Key(key), random.next() & 1);
    const HandCommand c = lead(session.settings, s, session.state);
    EXPECT_TRUE(std::isfinite(c.tip.right + c.tip.up + c.tip.in + c.roll + c.scope.head + c.scope.post));
    EXPECT_TRUE(c.led >= kScope && c.led < 3);
    for (const float handle : session.state.handle) EXPECT_TRUE(handle >= 0 && handle <= 1);
  }
}

TEST(Help, NamesEveryKey) {
  for (int key = 0; key < int(Key::count); ++key) {
    const std::string name = name_of(Key(key));
    bool found = false;
    for (const HelpLine& line : help()) {
      std::string words = line.keys;
      for (char& c : words)
        if (c == ',') c = ' ';
      found |= (' ' + words + ' ').find(' ' + name + ' ') != std::string::npos;
      EXPECT_GT(std::string(line.action).size(), 5u);
    }
    EXPECT_TRUE(found) << name;
  }
}
