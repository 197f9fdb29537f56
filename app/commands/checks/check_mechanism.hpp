// What a file of a mechanism holds, for `trocar check`.
#pragma once

#include <filesystem>

#include <trocar/core/json.hpp>

namespace trocar::app {

/// By its ending (.urdf), or its list of links.
bool is_mechanism_file(const std::filesystem::path& path);
/// @throws core::BadInput with all faults of the file
Json describe_mechanism(const std::filesystem::path& path);

}  // namespace trocar::app
