// The report's part on numbers: the table of metrics with what the trainee did before and what the scripted surgeon
// did, and the learning curve.
#pragma once

#include <string>

#include <trocar/reports/report.hpp>

namespace trocar::reports {

std::string metrics_section(const Report& report);   ///< empty where nothing was measured
std::string learning_section(const Report& report);  ///< empty before the second attempt

}  // namespace trocar::reports
