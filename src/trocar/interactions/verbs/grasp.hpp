// Grasping: jaws that close on tissue hold the points between them; a pull beyond what friction bears slips.
#pragma once

#include <trocar/interactions/verbs/held.hpp>

namespace trocar::interactions {

/// Opens, keeps or ends the grip, and sets how far the jaws close: tissue between them keeps them apart. A grip that
/// ends without the hand's opening has slipped: ToolState::slipped counts those.
void update_grip(const ToolModel& model, const ToolShape& shape, const Bodies& bodies, ToolState& tool) noexcept;

/// Pulls the held points towards their places between the jaws.
void hold_loads(const ToolShape& shape, int tool_index, const Bodies& bodies, const ToolState& tool) noexcept;

/// After the tissue has moved: forces at the jaws, and slip where the pull exceeds friction x pinch.
/// hold[].force holds the forces on the tissue.
void slip(const ToolModel& model, const ToolShape& shape, const Bodies& bodies, ToolState& tool) noexcept;

}  // namespace trocar::interactions
