// Arrays as .npy files, version 1.0, which NumPy and nearly everything else reads.
//
//   write_npy("depth.npy", {600, 800}, std::span(depth));
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace trocar::pictures {

/// @param shape  its product is the number of values; rows first  @throws core::EnvironmentLacks
void write_npy(const std::filesystem::path& path, const std::vector<std::size_t>& shape, std::span<const float> values);
void write_npy(const std::filesystem::path& path, const std::vector<std::size_t>& shape,
               std::span<const std::uint16_t> values);

}  // namespace trocar::pictures
