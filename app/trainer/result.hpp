// Pause menu, and what is shown after an attempt.
#pragma once

#include <string>

#include <trocar/core/json.hpp>

#include "trainer/choice.hpp"

namespace trocar::app {

/// Pause menu. `why` is said where it was not asked for; `recording` is said, so that people find it.
/// @param display  how things are shown may be chosen: not while it counts
Choice draw_pause(const std::string& why, const std::string& recording, bool scored, bool display);
/// After the attempt. `report`: there is a page to open; `say`: how far it is, or empty
Choice draw_result(const Json& result, const std::string& mode, bool report, const std::string& say);

}  // namespace trocar::app
