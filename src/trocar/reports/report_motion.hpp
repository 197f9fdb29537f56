// The report's part on motion: tip paths in space and in three views, speeds and forces over time.
#pragma once

#include <trocar/reports/report.hpp>

namespace trocar::reports {

/// Null where the motion is not known.
Json motion_data(const Report& report);

}  // namespace trocar::reports
