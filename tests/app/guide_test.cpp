// What the window says during an exercise: keys of the step, why a key does nothing, bars of conditions, help that
// fits.
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include <trocar/attempt/lesson.hpp>
#include <trocar/attempt/session.hpp>
#include <trocar/devices/both_hands.hpp>

#include "guide/control_mark.hpp"
#include "guide/equipment.hpp"
#include "guide/key_lines.hpp"
#include "guide/nearness_view.hpp"
#include "guide/refusals.hpp"

using namespace trocar;
using namespace trocar::app;

namespace {

const attempt::Lesson& guide_lesson(const std::string& name) {
  static std::map<std::string, std::unique_ptr<attempt::Lesson>> lessons;
  std::unique_ptr<attempt::Lesson>& lesson = lessons[name];
  if (!lesson) lesson = attempt::load_lesson(name);
  return *lesson;
}

struct GuideKeys {
  const attempt::Lesson& lesson;
  sim::State state = sim::initial_state(lesson.model);
  bool scored = false, declares = false, seen = false;
  int led = devices::kScope;

  std::string press(devices::Key key) const {
    devices::HandSample sample;
    sample.pressed.set(key);
    return refusal({lesson.model, state, led, scored, declares, seen}, sample, {}, false);
  }
};

TEST(Refusals, SayInACameraExerciseThatThereIsTheEndoscopeOnly) {
  const GuideKeys keys{guide_lesson("basics/camera-0")};
  for (const devices::Key key :
       {devices::Key::one, devices::Key::tab, devices::Key::g, devices::Key::v, devices::Key::x})
    EXPECT_EQ(keys.press(key), "This exercise has the endoscope only.") << name_of(key);
  EXPECT_NE(keys.press(devices::Key::h), "");
  EXPECT_NE(keys.press(devices::Key::k), "");
  EXPECT_NE(keys.press(devices::Key::r), "") << "a straight endoscope has no light post";
  EXPECT_NE(keys.press(devices::Key::b), "");
  EXPECT_EQ(keys.press(devices::Key::zero), "");
  EXPECT_EQ(keys.press(devices::Key::w), "");
  const GuideKeys oblique{guide_lesson("basics/camera-30")};
  EXPECT_EQ(oblique.press(devices::Key::r), "");
}

TEST(Refusals, LetKeysWorkThatDoSomething) {
  GuideKeys keys{guide_lesson("suturing/needle-through")};
  keys.led = 0;
  for (const devices::Key key :
       {devices::Key::one, devices::Key::tab, devices::Key::g, devices::Key::v, devices::Key::h})
    EXPECT_EQ(keys.press(key), "") << name_of(key);
  keys.seen = true;
  EXPECT_EQ(keys.press(devices::Key::v), "This instrument is already in view.");
  keys.declares = true;
  EXPECT_EQ(keys.press(devices::Key::k), "");
  keys.led = devices::kScope;
  EXPECT_NE(keys.press(devices::Key::g), "") << "the endoscope has no jaws";
}

TEST(Refusals, SayWhyTheLayoutStaysWhileTheExerciseIsScored) {
  const GuideKeys keys{guide_lesson("basics/camera-0")};
  const KeySituation scored{keys.lesson.model, keys.state, devices::kScope, true};
  EXPECT_NE(refusal(scored, {}, {}, true), "");
  EXPECT_EQ(refusal(scored, {}, {}, false), "");
}

TEST(KeyLines, NameTheEndoscopesKeyOnTheDeviceInUseUntilItIsControlled) {
  const attempt::Lesson& lesson = guide_lesson("basics/camera-0");
  const sim::State state = sim::initial_state(lesson.model);
  const std::string hint = "bring the disc into the middle";
  training::StepNeeds needs;
  needs.endoscope = true;
  const auto lines = [&](core::KeyDevice device, int led, const std::string& text) {
    return key_lines({needs, text, device, led, lesson.model, state});
  };
  ASSERT_EQ(lines(core::KeyDevice::mouse_and_keys, 0, hint).size(), 1u);
  EXPECT_EQ(lines(core::KeyDevice::mouse_and_keys, 0, hint)[0], "Endoscope: 0, then mouse.");
  EXPECT_EQ(lines(core::KeyDevice::gamepad, 0, hint)[0], "Endoscope: right shoulder, then left stick.");
  EXPECT_TRUE(lines(core::KeyDevice::gamepad, 0, "{key:endoscope} first").empty()) << "the hint says it itself";
  needs = {};
  needs.energy = needs.declare = true;
  const std::vector<std::string> both = lines(core::KeyDevice::mouse_and_keys, 0, hint);
  EXPECT_EQ(both, (std::vector<std::string>{"Foot switches: B coagulates, N cuts.", "Declare: K."}));
}

TEST(NearnessBar, ShowsWhatIsCollectedFromTheLeftAndATargetAsAZone) {
  training::Nearness row = training::counted("Hold", 0.5, 2, "s");
  EXPECT_TRUE(bar_of(row).filled);
  EXPECT_FLOAT_EQ(bar_of(row).value, 0.25f);
  row.low = -5, row.high = 5, row.value = 0;
  const NearnessBar level = bar_of(row);
  EXPECT_FALSE(level.filled);
  EXPECT_LT(level.from, level.value);
  EXPECT_GT(level.to, level.value);
  row.value = 40;
  EXPECT_GT(bar_of(row).value, bar_of(row).to) << "outside of its zone";
  row.known = false;
  EXPECT_LT(bar_of(row).value, 0) << "nothing is known: no pointer";
}

TEST(Equipment, OfACameraExerciseHasNoInstruments) {
  const Equipment straight = equipment_of(guide_lesson("basics/camera-0").model, false);
  EXPECT_EQ(straight.hands, 0);
  for (const devices::HelpLine& line : devices::help())
    EXPECT_EQ(straight.has(line.needs), line.needs == devices::HelpNeeds::nothing) << line.action;
  EXPECT_TRUE(equipment_of(guide_lesson("basics/camera-30").model, false).has(devices::HelpNeeds::oblique));
  const Equipment suture = equipment_of(guide_lesson("suturing/needle-through").model, false);
  EXPECT_TRUE(suture.jaws);
  EXPECT_FALSE(suture.energy);
}

TEST(ControlMark, FindsATipInTheCircleAndElseItsDirection) {
  const attempt::Lesson& lesson = guide_lesson("suturing/needle-through");
  const sim::State state = sim::initial_state(lesson.model);
  const int hands = int(lesson.model.hands.size());
  for (int h = 0; h < hands; ++h) {
    const TipInPicture at = tip_in_circle(lesson.model, state, h);
    const float size = std::hypot(at.right, at.up);
    EXPECT_TRUE(at.in_view ? size < 1 : std::abs(size - 1) < 1e-3f) << h << ' ' << size;
  }
}

}  // namespace
