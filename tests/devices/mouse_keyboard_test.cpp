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

TEST(Gamepad, ATriggerTakesUpAHandleWhereItWasLeft) {
  Session session;
  HandSample pulled;
  const auto pull = [&](float to) {
    pulled.gamepad.right_trigger = to;
    for (int i = 0; i < 100; ++i) session.give(pulled);
    return session.state.handle[0];
  };
  EXPECT_EQ(pull(0.4f), 0.4f);
  session.press(Key::zero);  // a look with the endoscope, and back
  session.press(Key::one);
  EXPECT_EQ(pull(0), 0.4f);
  EXPECT_EQ(pull(0.2f), 0.4f);
  EXPECT_EQ(pull(0.5f), 0.5f);
  EXPECT_EQ(pull(0.2f), 0.2f);
}

TEST(Gamepad, ShouldersGoRoundAllInstrumentsAndTheScope) {
  Session session;
  HandSample right, left;
  right.gamepad.set(Button::right_shoulder);
  left.gamepad.set(Button::left_shoulder);
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

TEST(Keyboard, AloneItMovesTheTipInAllDirectionsAndClosesTheJaws) {
  Session session;
  for (int i = 0; i < 60; ++i) session.give(Session::holding(Key::up));
  EXPECT_FLOAT_EQ(session.give(Session::holding(Key::up)).tip.up, kDt * session.settings.key_speed);
  EXPECT_LT(session.give(Session::holding(Key::left)).tip.right, 0);
  EXPECT_GT(session.give(Session::holding(Key::w)).tip.in, 0);
  EXPECT_GT(session.give(Session::holding(Key::page_up)).tip.in, 0);
  EXPECT_LT(session.give(Session::holding(Key::page_down)).tip.in, 0);
  for (int i = 0; i < 120; ++i) session.give(Session::holding(Key::g));
  EXPECT_EQ(session.state.handle[0], 1);
  session.press(Key::c);
  EXPECT_GT(session.give(Session::holding(Key::right)).scope.right, 0);
}

TEST(Keyboard, AnArrowTappedIsASmallStepAndHeldIsAQuickOne) {
  Session session;
  const float tapped = session.give(Session::holding(Key::right)).tip.right;
  for (int i = 0; i < 60; ++i) session.give(Session::holding(Key::right));
  const float held = session.give(Session::holding(Key::right)).tip.right;
  EXPECT_GT(held, 4 * tapped);
  session.rest(1);
  EXPECT_FLOAT_EQ(session.give(Session::holding(Key::right)).tip.right, tapped);
}

TEST(Mouse, AloneItLocksTheJawsAndOpensTheRackAndChoosesHands) {
  Session session;
  HandSample left, both, right;
  left.left_button = both.left_button = both.right_button = right.right_button = true;
  session.give(left);
  session.give(both);
  session.give(left);
  EXPECT_TRUE(session.state.ratchet[0]);
  const float grip = session.state.handle[0];
  session.rest(60);
  EXPECT_EQ(session.state.handle[0], grip);
  session.give(right);
  EXPECT_TRUE(session.give({}).rack);
  HandSample side;
  side.forward_button = true;
  EXPECT_EQ(session.give(side).led, 1);
  EXPECT_EQ(session.give(side).led, 1);
  HandSample wheel;
  wheel.middle_button = true;
  EXPECT_TRUE(session.give(wheel).rack);
  EXPECT_FALSE(session.give(wheel).rack);
}

TEST(Mouse, ARightDragIsNoTap) {
  Session session;
  HandSample drag = Session::moving(3, 0);
  drag.right_button = true;
  for (int i = 0; i < 5; ++i) session.give(drag);
  EXPECT_FALSE(session.give({}).rack);
  HandSample slow;
  slow.right_button = true;
  for (int i = 0; i < 40; ++i) session.give(slow);
  EXPECT_FALSE(session.give({}).rack);
}

TEST(Hands, FineMotionSlowsClosingEnoughForAClip) {
  Session session;
  session.state.fine = true;
  session.squeeze(60);
  EXPECT_LT(session.state.handle[0], 0.45f);  // half of the way takes more than a second
  EXPECT_GT(session.state.handle[0], 0.3f);
}

TEST(Hands, LeftHandedExchangesButtonsSidesAndOrder) {
  Session session;
  session.settings.left_handed = true;
  EXPECT_EQ(session.give(Session::with(Key::one)).led, 2);
  HandSample right;
  right.right_button = true;
  session.give({});
  for (int i = 0; i < 10; ++i) session.give(right);
  EXPECT_GT(session.state.handle[2], 0);
  HandSample stick;
  stick.gamepad.right_x = 1;
  EXPECT_GT(session.give(stick).tip.right, 0);
  stick = {};
  stick.gamepad.set(Button::right_shoulder);
  EXPECT_EQ(session.give(stick).led, 1);
}

TEST(Hands, TurnedDirectionsTurnOnlyWhatTheyName) {
  Session session;
  session.settings.invert_x = session.settings.invert_view_y = true;
  const HandCommand tip = session.give(Session::moving(5, 5));
  EXPECT_LT(tip.tip.right, 0);
  EXPECT_LT(tip.tip.up, 0);
  session.press(Key::c);
  const HandCommand scope = session.give(Session::moving(5, 5));
  EXPECT_GT(scope.scope.right, 0);
  EXPECT_GT(scope.scope.up, 0);
}

TEST(Hands, AfterAPauseOrALostDeviceEveryGripIsKept) {
  Session session;
  HandSample pulled;
  pulled.gamepad.right_trigger = 0.8f;
  for (int i = 0; i < 60; ++i) session.give(pulled);
  take_up(session.settings, {}, session.state);  // unplugged while the trigger was pulled
  session.rest(120);
  EXPECT_EQ(session.state.handle[0], 0.8f);
  session.squeeze(2);
  session.rest(60);
  EXPECT_EQ(session.state.handle[0], 0);
}

TEST(Hands, WhatWasHeldDownInAMenuIsNotPressedAfterIt) {
  Session session;
  HandSample held;
  held.gamepad.set(Button::y);
  held.gamepad.set(Button::x);
  held.left_button = true;
  take_up(session.settings, held, session.state);
  const HandCommand command = session.give(held);
  EXPECT_FALSE(command.rack);
  EXPECT_FALSE(command.insert);
  session.squeeze(30);
  EXPECT_EQ(session.state.handle[0], 0);
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
    s.middle_button = random.next() & 1, s.back_button = random.next() & 1, s.forward_button = random.next() & 1;
    s.gamepad = {any(), any(), any(), any(), any(), any(), std::uint32_t(random.next())};
    session.settings.left_handed = random.next() & 1;
    for (int key = 0; key < int(Key::count); ++key) s.held.set(Key(key), random.next() & 1);
    for (int key = 0; key < int(Key::count); ++key) s.pressed.set(Key(key), random.next() & 1);
    const HandCommand c = lead(session.settings, s, session.state);
    EXPECT_TRUE(std::isfinite(c.tip.right + c.tip.up + c.tip.in + c.roll + c.scope.head + c.scope.post));
    EXPECT_TRUE(c.led >= kScope && c.led < 3);
    for (const float handle : session.state.handle) EXPECT_TRUE(handle >= 0 && handle <= 1);
  }
}

TEST(Valves, KeysOpenThemAsLongAsTheyAreHeldAndForTheLedInstrumentOnly) {
  Session session;
  session.state.valves[1] = true;
  session.press(Key::two);
  session.rest(1);
  EXPECT_TRUE(session.give(Session::holding(Key::a)).irrigate);
  EXPECT_FALSE(session.give(Session::holding(Key::a)).suck);
  EXPECT_TRUE(session.give(Session::holding(Key::d)).suck);
  const HandCommand released = session.give({});
  EXPECT_FALSE(released.irrigate || released.suck);
  session.press(Key::one);
  const HandCommand jaws = session.give(Session::holding(Key::d));
  EXPECT_FALSE(jaws.irrigate || jaws.suck) << "jaws have no valves";
}

TEST(Valves, TheMouseAloneAndTheGamepadAloneOpenThem) {
  Session session;
  session.state.valves[0] = true;
  session.rest(1);
  HandSample mouse = Session::moving(30, 0);
  mouse.left_button = true;
  EXPECT_TRUE(session.give(mouse).suck);
  EXPECT_EQ(session.state.handle[0], 0) << "nothing closes";
  mouse.left_button = false;
  mouse.right_button = true;
  const HandCommand washing = session.give(mouse);
  EXPECT_TRUE(washing.irrigate);
  EXPECT_GT(washing.tip.right, 0) << "it is led on meanwhile";
  EXPECT_EQ(washing.roll, 0);
  EXPECT_FALSE(session.give({}).rack) << "a short puff opens no menu";
  HandSample pad;
  pad.gamepad.right_trigger = 1;
  EXPECT_TRUE(session.give(pad).suck);
  pad.gamepad.right_trigger = 0;
  pad.gamepad.left_trigger = 1;
  EXPECT_TRUE(session.give(pad).irrigate);
  EXPECT_FALSE(session.state.ratchet[0]);
}

TEST(Valves, WhatWasHeldWhenTheInstrumentWasChosenFlowsOnlyWhenPressedAnew) {
  Session session;
  session.state.valves[1] = true;
  session.squeeze(3);
  HandSample still_held = Session::with(Key::two);
  still_held.left_button = true;
  EXPECT_FALSE(session.give(still_held).suck);
  session.rest(1);
  HandSample anew;
  anew.left_button = true;
  EXPECT_TRUE(session.give(anew).suck);
}

TEST(InjectionNeedle, GoesInAndOutByEveryDeviceAndNothingFlowsMeanwhile) {
  Session session;
  session.state.valves[0] = session.state.needle[0] = true;
  session.rest(1);
  session.press(Key::space);
  EXPECT_TRUE(session.state.ratchet[0]);
  session.rest(40);
  EXPECT_EQ(session.state.handle[0], 1) << "it has gone into its shaft";
  HandSample mouse;
  mouse.left_button = mouse.right_button = true;
  const HandCommand both = session.give(mouse);
  EXPECT_FALSE(both.suck || both.irrigate);
  mouse.right_button = false;
  session.give(mouse);
  EXPECT_FALSE(session.state.ratchet[0]);
  session.rest(40);
  EXPECT_EQ(session.state.handle[0], 0) << "it is out again";
  HandSample pad;
  pad.gamepad.set(Button::right_stick, true);
  EXPECT_FALSE(session.give(pad).yellow) << "no foot switch is meant";
  EXPECT_TRUE(session.state.ratchet[0]);
  session.rest(1);
  pad = {};
  pad.gamepad.left_trigger = 1;
  EXPECT_TRUE(session.give(pad).irrigate);
  EXPECT_TRUE(session.state.ratchet[0]) << "the trigger presses the plunger and nothing else";
}

TEST(MouseKeyboard, WhoLetsBothButtonsGoAtOnceHasLockedTheJawsAndOpenedNoMenu) {
  Session session;
  session.squeeze(20);
  HandSample both;
  both.left_button = both.right_button = true;
  EXPECT_FALSE(session.give(both).rack);
  EXPECT_FALSE(session.give({}).rack);
  EXPECT_TRUE(session.state.ratchet[0]);
  const float handle = session.state.handle[0];
  session.rest(20);
  EXPECT_EQ(session.state.handle[0], handle);
}

TEST(Electrode, WhatClosesJawsCoagulatesWithAHookAndWhatLocksThemCuts) {
  Session session;
  session.state.electrode[0] = true;
  session.rest(1);
  HandSample mouse = Session::moving(30, 0);
  mouse.left_button = true;
  const HandCommand coagulating = session.give(mouse);
  EXPECT_TRUE(coagulating.blue && !coagulating.yellow);
  EXPECT_GT(coagulating.tip.right, 0) << "it is led on meanwhile";
  EXPECT_EQ(session.state.handle[0], 0) << "nothing closes";
  EXPECT_FALSE(session.give({}).blue);
  EXPECT_TRUE(session.give(Session::holding(Key::g)).blue);
  EXPECT_TRUE(session.give(Session::holding(Key::space)).yellow);
  HandSample pad;
  pad.gamepad.right_trigger = 1;
  pad.gamepad.left_x = 1;
  const HandCommand pulled = session.give(pad);
  EXPECT_TRUE(pulled.blue && pulled.tip.right > 0);
  pad.gamepad.right_trigger = 0;
  pad.gamepad.left_trigger = 1;
  EXPECT_TRUE(session.give(pad).yellow);
  EXPECT_FALSE(session.state.ratchet[0]);
  HandSample rolling = Session::moving(30, 0);
  rolling.right_button = true;
  EXPECT_NE(session.give(rolling).roll, 0) << "a hook's foot is turned as jaws are";
}

TEST(Electrode, WhatWasHeldWhenTheHookWasChosenBurnsOnlyWhenPressedAnew) {
  Session session;
  session.state.electrode[1] = true;
  session.squeeze(3);
  HandSample still_held = Session::with(Key::two);
  still_held.left_button = true;
  EXPECT_FALSE(session.give(still_held).blue);
  session.rest(1);
  HandSample anew;
  anew.left_button = true;
  EXPECT_TRUE(session.give(anew).blue);
}

TEST(Wipe, IsAskedForWhoeverIsLed) {
  Session session;
  EXPECT_TRUE(session.give(Session::holding(Key::t)).wipe);
  session.press(Key::zero);
  HandSample pad;
  pad.gamepad.set(Button::b);
  EXPECT_TRUE(session.give(pad).wipe);
  EXPECT_FALSE(session.give({}).wipe);
}

TEST(Declaration, IsHeardForAsLongAsTheKeyIsHeldWhoeverIsLed) {
  Session session;
  for (const Key hand : {Key::one, Key::zero}) {
    session.press(hand);
    EXPECT_TRUE(session.give(Session::holding(Key::k)).declare);
    EXPECT_FALSE(session.give({}).declare);
  }
}

TEST(MouseKeyboard, FootSwitchesWorkAsLongAsTheyAreHeldWhoeverIsLed) {
  Session session;
  for (const Key hand : {Key::one, Key::two, Key::zero}) {
    session.press(hand);
    const HandCommand blue = session.give(Session::holding(Key::b)), yellow = session.give(Session::holding(Key::n));
    EXPECT_TRUE(blue.blue && !blue.yellow);
    EXPECT_TRUE(yellow.yellow && !yellow.blue);
    EXPECT_TRUE(still(blue) && still(yellow));
  }
  HandSample pad;
  pad.gamepad.set(Button::a);
  EXPECT_TRUE(session.give(pad).blue);
  pad.gamepad.set(Button::right_stick);
  const HandCommand both = session.give(pad), none = session.give({});
  EXPECT_TRUE(both.blue && both.yellow);
  EXPECT_FALSE(none.blue || none.yellow);
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
