// What a check finds suspicious in a file that can be used.
#pragma once

#include <vector>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/text.hpp>

namespace trocar::app {

/// Sets "warnings" and the verdict, if there are any.
inline void add_warnings(Json& out, const std::vector<core::Fault>& warnings) {
  if (warnings.empty()) return;
  for (const core::Fault& warning : warnings) out["warnings"].push_back(core::to_string(warning));
  out["verdict"] = "to mend";
}
inline void print_warnings(const Json& out) {
  if (!out.contains("warnings")) return;
  for (const Json& warning : out["warnings"]) fmt::print("{}", tr("  warning: {}\n", warning.get<std::string>()));
}

}  // namespace trocar::app
