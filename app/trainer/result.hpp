// What is shown after an attempt.
#pragma once

#include <string>

#include <trocar/core/json.hpp>

#include "trainer/choice.hpp"

namespace trocar::app {

/// After the attempt. `report`: there is a page to open; `say`: how far it is, or empty
Choice draw_result(const Json& result, const std::string& mode, bool report, const std::string& say);

}  // namespace trocar::app
