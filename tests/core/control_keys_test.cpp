// Names of controls in hints, and what they are called on each device.
#include <gtest/gtest.h>

#include <trocar/core/controls/control_keys.hpp>

using namespace trocar::core;

TEST(ControlKeys, AreReplacedByTheLabelOfTheDevice) {
  const std::string hint = "Say it: {key:declare}. Keep {near_mm} mm.";
  EXPECT_EQ(with_keys(hint, KeyDevice::mouse_and_keys), "Say it: K. Keep {near_mm} mm.");
  EXPECT_EQ(with_keys(hint, KeyDevice::gamepad), "Say it: both shoulders and B. Keep {near_mm} mm.");
  EXPECT_EQ(with_keys("{key:pedal_cut}", KeyDevice::box), "yellow pedal");
  EXPECT_EQ(with_keys("{key:both_hands}", KeyDevice::box), "H") << "the box has none: the keyboard's";
}

TEST(ControlKeys, UnknownNamesStayAndAreFound) {
  const std::string hint = "{key:declare} {key:dance} {key:open";
  EXPECT_EQ(with_keys(hint, KeyDevice::gamepad_both), "both shoulders and B {key:dance} {key:open");
  EXPECT_EQ(unknown_keys(hint), std::vector<std::string>{"dance"});
}

TEST(ControlKeys, EveryOneHasALabelOnEveryDevice) {
  for (const ControlKey& key : control_keys())
    for (const KeyDevice device :
         {KeyDevice::mouse_and_keys, KeyDevice::gamepad, KeyDevice::gamepad_both, KeyDevice::box})
      EXPECT_NE(key_label(key.name, device), "") << key.name;
}
