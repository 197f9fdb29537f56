// Layout of the window and cameras of its panes, as a menu: what the pointer does by dragging, with buttons, for keys
// and gamepads.
#pragma once

#include "shell/panes.hpp"

namespace trocar::app {

/// @param choice  in/out  @return closed
bool draw_layout_panel(LayoutChoice& choice, Panes& panes);

}  // namespace trocar::app
