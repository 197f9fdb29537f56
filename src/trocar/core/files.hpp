// Whole files, as bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace trocar::core {

/// Throws BadInput (path:0:0) where there is no file, no more than a folder, more than `most` bytes, or none to be had.
std::string read_file(const std::filesystem::path& path, std::uint64_t most);

/// Puts the bytes into a file at once and for good: written beside it, flushed to the disk, then renamed, so that
/// an interrupted write leaves the old one.
/// @param mode  of a new file; one that is there keeps its own
/// @return empty, or what the system says is wrong
std::string write_file(const std::filesystem::path& path, const void* bytes, std::size_t size, unsigned mode = 0644);

}  // namespace trocar::core
