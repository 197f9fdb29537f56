// Attempts as tables for other programs: one row an attempt, one column a figure.
#pragma once

#include <string>
#include <vector>

#include <trocar/core/json.hpp>
#include <trocar/training/store/attempt.hpp>

namespace trocar::reports {

/// An attempt's result as it was kept; an object without members where that is none.
Json result_of(const training::Attempt& attempt);

/// RFC 4180, UTF-8, a line of column names with units. Without `names` trainees are "T1", "T2", ... in the order in
/// which they first appear. Columns of metrics are those that any of the attempts has.
std::string attempts_csv(const std::vector<training::Attempt>& attempts, bool names);

/// The same as JSON, with each attempt's whole result.
Json attempts_json(const std::vector<training::Attempt>& attempts, bool names);

/// One field: quoted where it must be, and never taken for a formula by a spreadsheet.
std::string csv_field(const std::string& text);

}  // namespace trocar::reports
