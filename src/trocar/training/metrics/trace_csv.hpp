// Whose motion a trace's CSV file holds: two comment lines that traces in the store do not need.
#pragma once

#include <string>
#include <string_view>

#include <trocar/training/metrics/trace.hpp>

namespace trocar::training {

/// Empty where it is not said.
struct TraceOrigin {
  std::string person, trial;
  bool operator==(const TraceOrigin&) const = default;
};

/// Blanks and what separates columns become '_' in both names.
std::string to_csv(const Trace& trace, const TraceOrigin& origin);
/// @throws core::BadInput, naming `name`, line and column
Trace trace_from_csv(std::string_view text, const std::string& name, TraceOrigin& origin);
/// Does a text begin as such a file does?
bool is_trace_csv(std::string_view text);

}  // namespace trocar::training
