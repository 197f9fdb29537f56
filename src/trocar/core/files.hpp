// Whole files, as bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace trocar::core {

/// Throws BadInput (path:0:0) where there is no file, no more than a folder, more than `most` bytes, or none to be had.
std::string read_file(const std::filesystem::path& path, std::uint64_t most);

}  // namespace trocar::core
