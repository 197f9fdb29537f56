#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/devices/both_hands.hpp>

using namespace trocar::devices;

namespace {

constexpr float kPictureTime = 1.0f / 60;

/// Both hands are led, of three instruments the first two; everything has been at rest.
struct Pair {
  HandSettings settings;
  BothHands hands;

  explicit Pair(bool on = true) {
    settings.instruments = 3;
    lead_both(settings, on, hands);
    rest(1);
  }
  HandCommands give(HandSample sample) {
    sample.dt = kPictureTime;
    return lead(settings, sample, hands);
  }
  HandCommands give(const Gamepad& pad) {
    HandSample sample;
    sample.gamepad = pad;
    return give(sample);
  }
  void rest(int samples) {
    for (int i = 0; i < samples; ++i) give(HandSample{});
  }
  template <class What>
  void give(const What& what, int samples) {
    for (int i = 0; i < samples; ++i) give(what);
  }
  void press(Key key) {
    HandSample sample;
    sample.pressed.set(key);
    give(sample);
  }
  void press(Button button) {
    Gamepad pad;
    pad.set(button);
    give(pad);
    rest(1);
  }
  float handle(int hand) const { return hands.state.handle[std::size_t(hand)]; }
  std::array<float, kMaxHands> handles() const { return hands.state.handle; }
};

/// What this one was told, and nothing where it was not told anything.
HandCommand of(int led, const HandCommands& commands) {
  for (const HandCommand& c : commands)
    if (c.led == led) return c;
  HandCommand none;
  none.led = led;
  return none;
}

bool at_rest(const HandCommand& c) {
  return c.tip.right == 0 && c.tip.up == 0 && c.tip.in == 0 && c.roll == 0 && c.scope.right == 0 && c.scope.up == 0 &&
         c.scope.in == 0 && c.scope.head == 0 && c.scope.post == 0;
}

bool at_rest(const HandCommands& commands) {
  for (const HandCommand& c : commands)
    if (!at_rest(c)) return false;
  return true;
}

Gamepad pad_with(std::initializer_list<Button> buttons) {
  Gamepad pad;
  for (const Button b : buttons) pad.set(b);
  return pad;
}

constexpr Button kLB = Button::left_shoulder, kRB = Button::right_shoulder;

}  // namespace

TEST(BothHands, NothingTouchedNothingMoves) {
  Pair pair;
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(at_rest(pair.give(HandSample{})));
  EXPECT_EQ(pair.handles(), (std::array<float, kMaxHands>{}));
}

TEST(BothHands, SwitchedOffEverySampleMeansWhatItMeansToOneHand) {
  Pair pair(false);
  HandState alone;
  HandSample resting;
  resting.dt = kPictureTime;
  lead(pair.settings, resting, alone);
  trocar::core::Random random(3);
  for (int i = 0; i < 2000; ++i) {
    HandSample s;
    s.dt = kPictureTime, s.dx = float(random.next() % 9), s.wheel = float(random.next() % 3);
    s.left_button = random.next() % 4 == 0, s.right_button = random.next() % 4 == 0;
    s.gamepad = {0, 1, -1, 0, float(random.next() % 2), float(random.next() % 2), std::uint32_t(random.next())};
    if (s.gamepad.has(kLB)) s.gamepad.set(kRB, false);  // both and Y switch it on
    for (int key = 0; key < int(Key::h); ++key) s.pressed.set(Key(key), random.next() % 8 == 0);
    const HandCommand one = lead(pair.settings, s, alone);
    const HandCommands commands = pair.give(s);
    ASSERT_EQ(commands.size(), 1);
    const HandCommand& same = *commands.begin();
    ASSERT_EQ(same.led, one.led);
    ASSERT_EQ(same.tip.right, one.tip.right);
    ASSERT_EQ(same.tip.in, one.tip.in);
    ASSERT_EQ(same.roll, one.roll);
    ASSERT_EQ(same.scope.up, one.scope.up);
    ASSERT_EQ(same.rack, one.rack);
    ASSERT_EQ(same.insert, one.insert);
    ASSERT_EQ(pair.handles(), alone.handle);
    ASSERT_EQ(pair.hands.state.ratchet, alone.ratchet);
  }
}

TEST(BothHandsPad, EachStickMovesTheTipOfItsSideInTheSameSample) {
  Pair pair;
  Gamepad pad;
  pad.left_x = 1, pad.right_y = -1;
  const HandCommands commands = pair.give(pad);
  const float step = kPictureTime * pair.settings.stick_speed;
  EXPECT_FLOAT_EQ(of(0, commands).tip.right, step);
  EXPECT_FLOAT_EQ(of(1, commands).tip.up, step);
  EXPECT_EQ(of(0, commands).tip.up, 0);
  EXPECT_EQ(of(1, commands).tip.right, 0);
  EXPECT_EQ(of(0, commands).tip.in, 0);
  EXPECT_EQ(of(1, commands).tip.in, 0);
}

TEST(BothHandsPad, AShoulderShiftsTheStickOfItsOwnSideOnly) {
  Pair pair;
  const float step = kPictureTime * pair.settings.stick_speed, turn = kPictureTime * pair.settings.stick_roll;
  Gamepad pad = pad_with({kLB});
  pad.left_x = 1, pad.left_y = -1, pad.right_x = 1, pad.right_y = -1;
  const HandCommands left = pair.give(pad);
  EXPECT_FLOAT_EQ(of(0, left).tip.in, step) << "pushed away is deeper";
  EXPECT_FLOAT_EQ(of(0, left).roll, turn);
  EXPECT_EQ(of(0, left).tip.right, 0);
  EXPECT_FLOAT_EQ(of(1, left).tip.right, step);
  EXPECT_FLOAT_EQ(of(1, left).tip.up, step);
  EXPECT_EQ(of(1, left).tip.in, 0);
  pad.buttons = pad_with({kRB}).buttons;
  const HandCommands right = pair.give(pad);
  EXPECT_FLOAT_EQ(of(1, right).tip.in, step);
  EXPECT_FLOAT_EQ(of(1, right).roll, turn);
  EXPECT_EQ(of(0, right).tip.in, 0);
  EXPECT_FLOAT_EQ(of(0, right).tip.up, step);
}

TEST(BothHandsPad, EachTriggerClosesTheJawsOfItsSideAndMovesNothing) {
  Pair pair;
  Gamepad pad;
  pad.left_trigger = 0.6f, pad.right_trigger = 0.3f;
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(at_rest(pair.give(pad)));
  EXPECT_EQ(pair.handle(0), 0.6f);
  EXPECT_EQ(pair.handle(1), 0.3f);
  EXPECT_EQ(pair.handle(2), 0.0f);
  pad.left_trigger = 0;
  pair.give(pad, 100);
  EXPECT_EQ(pair.handle(0), 0.0f);
  EXPECT_EQ(pair.handle(1), 0.3f);
}

TEST(BothHandsPad, AGripIsKeptWhileItsHandGoesDeeper) {
  Pair pair;
  Gamepad pad;
  pad.right_trigger = 0.7f;
  pair.give(pad, 100);
  pad.set(kRB);
  pad.right_y = -1;
  EXPECT_GT(of(1, pair.give(pad)).tip.in, 0);
  pair.give(pad, 100);
  EXPECT_EQ(pair.handle(1), 0.7f);
}

TEST(BothHandsPad, TheCrossLocksTheJawsOfEachSide) {
  Pair pair;
  Gamepad pad;
  pad.left_trigger = pad.right_trigger = 0.5f;
  pair.give(pad, 100);
  pad.set(Button::left);
  pair.give(pad, 5);  // one press, however long
  pair.rest(100);
  EXPECT_TRUE(pair.hands.state.ratchet[0]);
  EXPECT_FALSE(pair.hands.state.ratchet[1]);
  EXPECT_EQ(pair.handle(0), 0.5f);
  EXPECT_EQ(pair.handle(1), 0.0f);
  pair.press(Button::left);
  pair.rest(100);
  EXPECT_EQ(pair.handle(0), 0.0f);
}

TEST(BothHandsPad, OfASuctionIrrigatorTheTriggerSucksAndTheCrossGivesWater) {
  Pair pair;
  pair.hands.state.valves[1] = true;
  Gamepad pad;
  pad.left_trigger = pad.right_trigger = 1;
  const HandCommands sucking = pair.give(pad);
  EXPECT_TRUE(of(1, sucking).suck);
  EXPECT_FALSE(of(1, sucking).irrigate);
  EXPECT_FALSE(of(0, sucking).suck);
  EXPECT_GT(pair.handle(0), 0.0f) << "jaws beside it close";
  EXPECT_EQ(pair.handle(1), 0.0f) << "a tube has nothing to close";
  const HandCommands washing = pair.give(pad_with({Button::right}));
  EXPECT_TRUE(of(1, washing).irrigate);
  EXPECT_FALSE(of(1, washing).suck);
  EXPECT_FALSE(pair.hands.state.ratchet[1]);
}

TEST(BothHandsPad, TheRightStickMovesTheNeedleOfWhicheverHandHasOneAndPressesNoFootSwitchMeanwhile) {
  for (const int hand : {0, 1}) {
    Pair pair;
    pair.hands.state.valves[std::size_t(hand)] = pair.hands.state.needle[std::size_t(hand)] = true;
    const HandCommands commands = pair.give(pad_with({Button::right_stick}));
    for (const HandCommand& c : commands) EXPECT_FALSE(c.yellow) << "hand " << c.led;
    EXPECT_TRUE(pair.hands.state.ratchet[std::size_t(hand)]) << "out it goes";
    EXPECT_FALSE(pair.hands.state.ratchet[std::size_t(1 - hand)]);
  }
}

TEST(BothHandsPad, AHookCoagulatesByItsTriggerWhileItIsLedAndTheOtherJawsClose) {
  Pair pair;
  pair.hands.state.electrode[1] = true;
  Gamepad pad;
  pad.left_trigger = pad.right_trigger = 1;
  pad.right_x = 1;
  const HandCommands burning = pair.give(pad);
  EXPECT_TRUE(of(1, burning).blue && !of(1, burning).yellow);
  EXPECT_GT(of(1, burning).tip.right, 0) << "the thumb stays on its stick";
  EXPECT_FALSE(of(0, burning).blue);
  EXPECT_GT(pair.handle(0), 0.0f) << "jaws beside it close";
  EXPECT_EQ(pair.handle(1), 0.0f);
  EXPECT_TRUE(of(1, pair.give(pad_with({Button::right}))).yellow);
  EXPECT_FALSE(pair.hands.state.ratchet[1]);
}

TEST(BothHandsPad, BothShouldersLeadTheEndoscopeAndBothHandsKeepPoseAndGrip) {
  Pair pair;
  Gamepad pad;
  pad.left_trigger = 0.8f, pad.right_trigger = 0.4f;
  pair.give(pad, 100);
  pair.press(Button::left);  // lets the triggers go, and the left jaws are locked
  pad.right_trigger = 0.4f;
  pair.give(pad, 100);
  pad.set(kLB), pad.set(kRB);
  pad.left_x = 1, pad.left_y = -1, pad.right_x = 1, pad.right_y = -1;
  const HandCommands looking = pair.give(pad);
  EXPECT_TRUE(pair.hands.looking);
  const HandCommand scope = of(kScope, looking);
  EXPECT_FLOAT_EQ(scope.scope.right, kPictureTime * pair.settings.stick_view);
  EXPECT_FLOAT_EQ(scope.scope.up, kPictureTime * pair.settings.stick_view);
  EXPECT_FLOAT_EQ(scope.scope.in, kPictureTime * pair.settings.stick_speed);
  EXPECT_FLOAT_EQ(scope.scope.head, kPictureTime * pair.settings.stick_roll);
  EXPECT_EQ(scope.scope.post, 0);
  EXPECT_TRUE(at_rest(of(0, looking)) && at_rest(of(1, looking)));
  const auto before = pair.handles();
  pad.left_trigger = pad.right_trigger = 0;  // let go meanwhile
  pair.give(pad, 100);
  EXPECT_EQ(pair.handles(), before);
  pair.rest(100);
  EXPECT_EQ(pair.handles(), before) << "and not opened afterwards either";
  pad = {};
  pad.right_trigger = 0.5f;  // taken up where it was left
  pair.give(pad, 100);
  pair.rest(100);
  EXPECT_EQ(pair.handle(1), 0.0f);
}

TEST(BothHandsPad, ATriggerHeldThroughALookIsInChargeAfterIt) {
  Pair pair;
  Gamepad pad;
  pad.left_trigger = 0.6f;
  pair.give(pad, 100);
  pad.set(kLB), pad.set(kRB);
  pair.give(pad, 30);
  pad.buttons = 0;
  pair.give(pad, 5);
  EXPECT_EQ(pair.handle(0), 0.6f);
  pair.rest(100);
  EXPECT_EQ(pair.handle(0), 0.0f);
}

TEST(BothHandsPad, AStickThatLookedRestsBeforeItMovesATip) {
  Pair pair;
  Gamepad pad = pad_with({kLB, kRB});
  pad.left_x = pad.right_y = 1;
  pair.give(pad, 5);
  pad.set(kRB, false);
  EXPECT_TRUE(at_rest(pair.give(pad))) << "one finger is slower than the other";
  pad.set(kLB, false);
  EXPECT_TRUE(at_rest(pair.give(pad)));
  pad.left_x = 0;
  pair.give(pad);
  pad.left_x = 1;
  const HandCommands commands = pair.give(pad);
  EXPECT_GT(of(0, commands).tip.right, 0);
  EXPECT_TRUE(at_rest(of(1, commands))) << "the right one has not come to rest yet";
}

TEST(BothHandsPad, TheCrossTurnsTheLightPostWhileBothShouldersAreHeld) {
  Pair pair;
  const HandCommands commands = pair.give(pad_with({kLB, kRB, Button::right}));
  EXPECT_FLOAT_EQ(of(kScope, commands).scope.post, kPictureTime * pair.settings.post_per_second);
  pair.give(pad_with({Button::right}), 2);
  EXPECT_FALSE(pair.hands.state.ratchet[1]) << "held on, it locks nothing";
}

TEST(BothHandsPad, UpAndDownPutAnotherInstrumentInThePlaceOfTheOneLastUsed) {
  Pair pair;
  Gamepad pad;
  pad.left_x = 1;
  pair.give(pad);
  pair.press(Button::up);
  EXPECT_EQ(pair.hands.pair, (std::array<int, 2>{2, 1}));
  pair.press(Button::up);
  EXPECT_EQ(pair.hands.pair, (std::array<int, 2>{0, 1}));
  pad = {}, pad.right_x = 1;
  pair.give(pad);
  pair.press(Button::down);
  EXPECT_EQ(pair.hands.pair, (std::array<int, 2>{0, 2}));
  EXPECT_GT(of(2, pair.give(pad)).tip.right, 0);
}

TEST(BothHandsPad, FootSwitchesLensRackAndInsertionKeepTheirButtons) {
  Pair pair;
  const auto any = [&](bool HandCommand::*what, std::initializer_list<Button> buttons) {
    bool found = false;
    for (const HandCommand& c : pair.give(pad_with(buttons))) found |= c.*what;
    pair.rest(1);
    return found;
  };
  EXPECT_TRUE(any(&HandCommand::blue, {Button::a}));
  EXPECT_TRUE(any(&HandCommand::wipe, {Button::b}));
  EXPECT_TRUE(any(&HandCommand::yellow, {Button::right_stick}));
  EXPECT_TRUE(any(&HandCommand::rack, {Button::y}));
  EXPECT_TRUE(any(&HandCommand::blue, {kLB, kRB, Button::a}));
  EXPECT_TRUE(of(0, pair.give(pad_with({kLB, Button::x}))).insert) << "of the side whose shoulder is held";
  pair.press(Button::left_stick);
  Gamepad pad;
  pad.left_x = 1;
  EXPECT_FLOAT_EQ(of(0, pair.give(pad)).tip.right, pair.settings.fine * kPictureTime * pair.settings.stick_speed);
}

TEST(BothHandsMouseAndKeys, LeadOneHandEachInTheSameSample) {
  Pair pair;
  HandSample sample;
  sample.dx = 10, sample.wheel = 1;
  sample.left_button = true;
  sample.held.set(Key::up);
  sample.held.set(Key::e);
  const HandCommands commands = pair.give(sample);
  EXPECT_FLOAT_EQ(of(1, commands).tip.right, 10 * pair.settings.metres_per_pixel);
  EXPECT_FLOAT_EQ(of(1, commands).tip.in, pair.settings.metres_per_notch);
  EXPECT_EQ(of(1, commands).tip.up, 0);
  EXPECT_EQ(of(1, commands).roll, 0);
  EXPECT_GT(of(0, commands).tip.up, 0);
  EXPECT_GT(of(0, commands).roll, 0);
  EXPECT_EQ(of(0, commands).tip.right, 0);
  EXPECT_GT(pair.handle(1), 0.0f);
  EXPECT_EQ(pair.handle(0), 0.0f);
  sample = {};
  sample.held.set(Key::g);
  pair.give(sample, 60);
  EXPECT_GT(pair.handle(0), 0.9f);
  EXPECT_EQ(pair.handle(1), 0.0f) << "the mouse has let it go meanwhile";
  pair.press(Key::space);
  pair.rest(60);
  EXPECT_GT(pair.handle(0), 0.9f) << "locked by the hand that the keys lead";
}

TEST(BothHandsMouseAndKeys, TabExchangesThemAndEveryGripIsKept) {
  Pair pair;
  HandSample squeezed;
  squeezed.left_button = true;
  pair.give(squeezed, 60);
  HandSample change = squeezed;
  change.pressed.set(Key::tab);
  pair.give(change);
  pair.give(squeezed, 30);
  EXPECT_EQ(pair.handle(0), 0.0f) << "a button that was down is not meant for the other hand";
  pair.rest(60);
  EXPECT_GT(pair.handle(1), 0.9f);
  HandSample moving;
  moving.dx = 10;
  moving.held.set(Key::up);
  const HandCommands commands = pair.give(moving);
  EXPECT_GT(of(0, commands).tip.right, 0);
  EXPECT_GT(of(1, commands).tip.up, 0);
}

TEST(BothHandsMouseAndKeys, ANumberIsTheMousesAndAThirdHandTakesItsPlace) {
  Pair pair;
  const auto moved_by_mouse = [&] {
    HandSample sample;
    sample.dx = 10;
    for (const HandCommand& c : pair.give(sample))
      if (!at_rest(c)) return c.led;
    return kScope;
  };
  EXPECT_EQ(moved_by_mouse(), 1);
  pair.press(Key::one);
  EXPECT_EQ(moved_by_mouse(), 0);
  EXPECT_EQ(pair.hands.pair, (std::array<int, 2>{0, 1})) << "nobody changes sides";
  pair.press(Key::three);
  EXPECT_EQ(pair.hands.pair, (std::array<int, 2>{2, 1}));
  EXPECT_EQ(moved_by_mouse(), 2);
  pair.press(Key::four);  // there is none
  EXPECT_EQ(moved_by_mouse(), 2);
}

TEST(BothHandsMouseAndKeys, TheEndoscopeIsLedByBothUntilAHandIsChosen) {
  for (const Key back : {Key::tab, Key::two}) {
    Pair pair;
    pair.press(Key::zero);
    HandSample sample;
    sample.dx = 10;
    sample.held.set(Key::up);
    const HandCommands looking = pair.give(sample);
    EXPECT_FLOAT_EQ(of(kScope, looking).scope.right, 10 * pair.settings.view_per_pixel);
    EXPECT_GT(of(kScope, looking).scope.up, 0);
    EXPECT_TRUE(at_rest(of(0, looking)) && at_rest(of(1, looking)));
    EXPECT_EQ(pair.hands.state.led, kScope);
    pair.press(back);
    EXPECT_EQ(pair.hands.mouse, kRight);
    EXPECT_GT(of(1, pair.give(sample)).tip.right, 0);
  }
}

TEST(BothHandsMouseAndKeys, SideButtonsTakeTheMouseRoundBothHandsAndTheEndoscope) {
  Pair pair;
  HandSample next;
  next.forward_button = true;
  pair.give(next, 3);
  EXPECT_EQ(pair.hands.state.led, kScope);
  pair.rest(1);
  pair.give(next, 3);
  EXPECT_EQ(pair.hands.mouse, kLeft);
  EXPECT_EQ(pair.hands.state.led, 0);
  pair.rest(1);
  pair.give(next, 3);
  EXPECT_EQ(pair.hands.mouse, kRight);
  EXPECT_EQ(pair.hands.state.led, 1);
}

TEST(BothHandsMode, BothShouldersWithBDeclareAndWipeNothing) {
  for (const bool both : {false, true}) {
    Pair pair(both);
    pair.give(pad_with({kLB, kRB}));
    bool declared = false;
    for (const HandCommand& c : pair.give(pad_with({kLB, kRB, Button::b}))) {
      declared |= c.declare;
      EXPECT_FALSE(c.wipe);
    }
    EXPECT_TRUE(declared) << (both ? "both hands" : "one hand");
    for (const HandCommand& c : pair.give(HandSample{})) EXPECT_FALSE(c.declare);
  }
}

TEST(BothHandsMode, IsSwitchedByAKeyAndByBothShouldersWithY) {
  Pair pair(false);
  pair.press(Key::h);
  EXPECT_TRUE(leads_both(pair.settings, pair.hands));
  EXPECT_EQ(pair.give(HandSample{}).size(), 2);
  pair.press(Key::h);
  EXPECT_FALSE(leads_both(pair.settings, pair.hands));
  EXPECT_EQ(pair.give(HandSample{}).size(), 1);
  for (const bool on : {true, false}) {
    pair.give(pad_with({kLB}));
    pair.give(pad_with({kLB, kRB}));
    for (int i = 0; i < 3; ++i) {
      for (const HandCommand& c : pair.give(pad_with({kLB, kRB, Button::y}))) EXPECT_FALSE(c.rack);
      EXPECT_EQ(leads_both(pair.settings, pair.hands), on);
    }
    for (const HandCommand& c : pair.give(pad_with({Button::y}))) EXPECT_FALSE(c.rack) << "held on, it is no new press";
    pair.rest(1);
  }
  bool rack = false;
  for (const HandCommand& c : pair.give(pad_with({Button::y}))) rack |= c.rack;
  EXPECT_TRUE(rack);
}

TEST(BothHandsMode, TakesTwoInstruments) {
  Pair pair(false);
  pair.settings.instruments = 1;
  pair.press(Key::h);
  EXPECT_FALSE(pair.hands.on);
  lead_both(pair.settings, true, pair.hands);  // remembered from a scene with two
  EXPECT_FALSE(leads_both(pair.settings, pair.hands));
  HandSample sample;
  sample.dx = 5;
  const HandCommands commands = pair.give(sample);
  EXPECT_EQ(commands.size(), 1);
  EXPECT_GT(of(0, commands).tip.right, 0);
}

TEST(BothHandsMode, TheHandThatWasControlledAloneIsOfThePairAndIsControlledAloneAgain) {
  Pair pair(false);
  pair.press(Key::three);
  pair.press(Key::h);
  EXPECT_EQ(pair.hands.pair, (std::array<int, 2>{0, 2}));
  EXPECT_EQ(pair.hands.state.led, 2);
  Gamepad pad;
  pair.rest(1);
  pad.left_x = 1;
  pair.give(pad, 3);
  pair.press(Key::h);
  EXPECT_EQ(pair.hands.state.led, 2);
  HandSample sample;
  sample.dx = 5;
  EXPECT_GT(of(2, pair.give(sample)).tip.right, 0);
}

TEST(BothHandsMode, EndsWithTheEndoscopeWhereItBeganWithIt) {
  Pair pair(false);
  pair.press(Key::zero);
  pair.press(Key::h);
  EXPECT_NE(pair.hands.state.led, kScope);
  pair.press(Key::h);
  EXPECT_EQ(pair.hands.state.led, kScope);
}

TEST(BothHandsMode, AlsoWhereItIsWantedTheEndoscopeIsControlledInASceneWithoutHands) {
  for (const bool both : {false, true}) {
    Pair pair(both);
    pair.settings.instruments = 0;
    for (const Key key : {Key::h, Key::tab, Key::one, Key::c}) {
      HandSample sample;
      sample.pressed.set(key);
      sample.dx = 5;
      const HandCommands commands = pair.give(sample);
      ASSERT_EQ(commands.size(), 1);
      EXPECT_EQ(commands.begin()->led, kScope);
      EXPECT_GT(commands.begin()->scope.right, 0);
      pair.rest(1);
    }
  }
}

TEST(BothHandsMode, SwitchingOpensAndClosesNoHandleByItself) {
  Pair pair(false);
  HandSample sample;
  sample.gamepad.right_trigger = 0.8f;
  sample.left_button = true;
  pair.give(sample, 30);
  for (int i = 0; i < 4; ++i) {
    const auto before = pair.handles();
    HandSample change = sample;
    change.pressed.set(Key::h);
    pair.give(change);
    pair.give(sample, 30);
    EXPECT_EQ(pair.handles(), before) << "held through the change";
    if (i % 2 == 1) pair.rest(60);
    EXPECT_EQ(pair.handles(), before) << "let go after it";
  }
}

TEST(BothHandsMode, AfterAPauseOrALostDeviceEveryGripIsKept) {
  Pair pair;
  Gamepad pad;
  pad.left_trigger = 0.8f, pad.right_trigger = 0.5f;
  pair.give(pad, 100);
  take_up(pair.settings, {}, pair.hands);  // unplugged
  pair.rest(100);
  EXPECT_EQ(pair.handle(0), 0.8f);
  EXPECT_EQ(pair.handle(1), 0.5f);
  HandSample held;  // in a menu
  held.gamepad = pad_with({Button::x, Button::y, Button::left, Button::up});
  held.gamepad.left_trigger = held.gamepad.right_trigger = 1;
  held.left_button = true;
  take_up(pair.settings, held, pair.hands);
  for (int i = 0; i < 60; ++i)
    for (const HandCommand& c : pair.give(held)) EXPECT_FALSE(c.rack || c.insert);
  EXPECT_EQ(pair.handle(0), 0.8f);
  EXPECT_EQ(pair.handle(1), 0.5f);
  EXPECT_FALSE(pair.hands.state.ratchet[0]);
  EXPECT_EQ(pair.hands.pair, (std::array<int, 2>{0, 1}));
}

TEST(BothHandsMode, TheRackChoosesTheOneThatIsSpokenOfAndExchangesPlaces) {
  Pair pair;
  choose(pair.settings, 0, pair.hands);
  EXPECT_EQ(pair.hands.state.led, 0);
  EXPECT_EQ(pair.hands.pair, (std::array<int, 2>{0, 1}));
  choose(pair.settings, 2, pair.hands);
  EXPECT_EQ(pair.hands.pair, (std::array<int, 2>{2, 1}));
  choose(pair.settings, kScope, pair.hands);
  EXPECT_EQ(pair.give(HandSample{}).begin()->led, kScope);
  choose(pair.settings, 1, pair.hands);
  EXPECT_EQ(pair.give(HandSample{}).size(), 2);
}

TEST(BothHandsMode, LeftHandedTheMouseIsInTheLeftHandAndTheRightStickLooks) {
  Pair pair;
  pair.settings.left_handed = true;
  take_up(pair.settings, {}, pair.hands);
  pair.rest(1);
  HandSample mouse;
  mouse.dx = 10;
  mouse.right_button = true;
  const HandCommands commands = pair.give(mouse);
  EXPECT_GT(of(0, commands).tip.right, 0) << "the right button of a mouse that lies at the left closes";
  pair.give(mouse, 20);
  EXPECT_GT(pair.handle(0), 0.0f);
  EXPECT_EQ(pair.handle(1), 0.0f);
  pair.rest(60);
  Gamepad pad;
  pad.left_x = 1, pad.left_trigger = 1;
  EXPECT_GT(of(0, pair.give(pad)).tip.right, 0) << "every stick leads the hand of its own side";
  pair.give(pad, 30);
  EXPECT_GT(pair.handle(0), 0.5f);
  EXPECT_EQ(pair.handle(1), 0.0f);
  pad = pad_with({kLB, kRB});
  pad.right_x = 1;
  EXPECT_GT(of(kScope, pair.give(pad)).scope.right, 0);
  pair.rest(1);
  pair.press(Key::one);
  EXPECT_EQ(pair.hands.pair, (std::array<int, 2>{2, 1})) << "numbers are counted from the other end";
}

TEST(BothHandsMode, TurnedDirectionsTurnBothTipsAndFineSlowsBoth) {
  Pair pair;
  pair.settings.invert_x = true;
  HandSample sample;
  sample.dx = 10;
  sample.held.set(Key::right);
  const HandCommands turned = pair.give(sample);
  EXPECT_LT(of(0, turned).tip.right, 0);
  EXPECT_FLOAT_EQ(of(1, turned).tip.right, -10 * pair.settings.metres_per_pixel);
  pair.rest(1);
  sample.held.set(Key::shift);
  const HandCommands fine = pair.give(sample);
  EXPECT_FLOAT_EQ(of(0, fine).tip.right, pair.settings.fine * of(0, turned).tip.right);
  EXPECT_FLOAT_EQ(of(1, fine).tip.right, pair.settings.fine * of(1, turned).tip.right);
}

TEST(BothHandsMode, ABrokenDeviceCannotBreakTheHands) {
  Pair pair;
  trocar::core::Random random(1);
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1e30f, 0, 1};
  const auto any = [&] { return bad[random.next() % 5]; };
  for (int i = 0; i < 10'000; ++i) {
    HandSample s;
    s.dt = any(), s.dx = any(), s.dy = bad[0], s.wheel = bad[1];
    if (!std::isfinite(s.dx)) s.dx = bad[0];
    s.left_button = random.next() & 1, s.right_button = random.next() & 1;
    s.middle_button = random.next() & 1, s.back_button = random.next() & 1, s.forward_button = random.next() & 1;
    s.gamepad = {any(), any(), any(), any(), any(), any(), std::uint32_t(random.next())};
    pair.settings.left_handed = random.next() & 1;
    for (int key = 0; key < int(Key::count); ++key) s.held.set(Key(key), random.next() & 1);
    for (int key = 0; key < int(Key::count); ++key) s.pressed.set(Key(key), random.next() % 8 == 0);
    for (const HandCommand& c : lead(pair.settings, s, pair.hands)) {
      EXPECT_TRUE(std::isfinite(c.tip.right + c.tip.up + c.tip.in + c.roll + c.scope.head + c.scope.post));
      EXPECT_TRUE(c.led >= kScope && c.led < 3);
    }
    EXPECT_NE(pair.hands.pair[0], pair.hands.pair[1]);
    for (const float handle : pair.handles()) EXPECT_TRUE(handle >= 0 && handle <= 1);
  }
}

TEST(BothHandsMode, WhatIsNoNumberIsRest) {
  Pair pair;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  HandSample sample;
  sample.dx = sample.dy = sample.wheel = nan;
  sample.gamepad = {nan, nan, nan, nan, nan, nan, 0};
  pair.give(sample, 3);
  EXPECT_TRUE(at_rest(pair.give(sample)));
  EXPECT_EQ(pair.handles(), (std::array<float, kMaxHands>{}));
  sample.gamepad = pad_with({kLB, kRB});
  sample.gamepad.left_x = nan;
  EXPECT_TRUE(at_rest(pair.give(sample)));
}

TEST(Help, TellsOfBothHandsWhatIsDifferentFromOne) {
  for (const HelpLine& line : help_both()) {
    EXPECT_GT(std::string(line.keys).size(), 0u);
    EXPECT_GT(std::string(line.action).size(), 5u);
  }
}
