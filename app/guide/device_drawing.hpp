// Drawings of mouse, keyboard and gamepad with the names of what their parts do here.
#pragma once

#include <string>
#include <vector>

#include <imgui.h>

#include "guide/equipment.hpp"

namespace trocar::app {

/// A mouse and the part of a keyboard that is used; keys that do something here are bright.
/// @param left_handed  the mouse's buttons are exchanged  @returns the height that was used [px]
float draw_mouse_and_keys(const Equipment& equipment, bool left_handed, ImVec2 at, float width);
float draw_gamepad(const Equipment& equipment, ImVec2 at, float width);

}  // namespace trocar::app
