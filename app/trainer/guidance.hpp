// How it is led: all keys, and the three things to know before the first attempt.
#pragma once

#include "trainer/choice.hpp"

namespace trocar::app {

/// All keys and buttons of the devices that are there. Resume closes it. @param both in/out: those of both hands at
/// once
Choice draw_help(bool gamepad, bool left_handed, bool& both);
/// The three things to know. @param again in/out: show it before the next attempt, too
Choice draw_hint(bool gamepad, bool both, bool& again);

}  // namespace trocar::app
