// The report's part on motion: tip paths in space and in three views, speeds and forces over time.
#pragma once

#include <string>

#include <trocar/reports/report.hpp>

namespace trocar::reports {

/// Empty where the motion is not known.
std::string motion_section(const Report& report);

}  // namespace trocar::reports
