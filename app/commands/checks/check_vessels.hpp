// What a file of vessels holds: every vessel's wall and what flows through it at rest, for `trocar check`.
#pragma once

#include <filesystem>

#include <trocar/core/json.hpp>

namespace trocar::app {

/// @throws core::BadInput with all faults of the file
Json describe_vessels(const std::filesystem::path& path);

/// The same in words and a table.
void print_vessels(const Json& vessels);

}  // namespace trocar::app
