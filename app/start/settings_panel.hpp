// The settings, over any screen: of the person who practises, and of the machine.
#pragma once

#include "shell/settings.hpp"

namespace trocar::app {

/// True: closed. `edited` is applied at once; `before` is what undo brings back.
/// @param quad_buffers  this window has them
bool draw_settings(Settings& edited, const Settings& before, bool sound, bool quad_buffers);

}  // namespace trocar::app
