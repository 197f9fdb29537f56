// How an exercise is controlled: help with drawings of the devices, and the three things to know before the first
// attempt. Both speak only of what the exercise has.
#pragma once

#include "guide/equipment.hpp"
#include "trainer/choice.hpp"

namespace trocar::app {

/// What help shows, kept while it is open.
struct HelpPage {
  bool gamepad = false;  ///< the gamepad's page; else mouse and keyboard
  bool both = false;     ///< keys while both hands are controlled at once
};

/// Keys and buttons of the device whose page is open. Resume closes it. @param page in/out
Choice draw_help(const Equipment& equipment, bool left_handed, HelpPage& page);
/// The three things to know. @param again in/out: show it before the next attempt, too
Choice draw_hint(const Equipment& equipment, bool gamepad, bool both, bool& again);

}  // namespace trocar::app
