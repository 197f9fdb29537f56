// The report's part on numbers: the table of metrics with what the trainee did before and what the demonstration
// did, and the learning curve.
#pragma once

#include <trocar/reports/report.hpp>

namespace trocar::reports {

Json metrics_data(const Report& report);   ///< null where nothing was measured
Json learning_data(const Report& report);  ///< null before the second attempt

}  // namespace trocar::reports
