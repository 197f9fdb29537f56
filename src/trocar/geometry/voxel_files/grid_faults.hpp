// What is wrong with a grid of voxels that a file describes. Used by the readers only.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include <trocar/numerics/mat3.hpp>

namespace trocar::geometry {

/// Sizes from 1 on, and at most so many voxels; nothing where they are.
/// @param announced  as the file has them, which may be beyond int
std::optional<std::string> size_fault(const std::array<std::int64_t, 3>& announced, std::size_t most_voxels);

/// Places up to 1e6 mm, steps from 1e-4 to 1e4 mm that span a voxel.
std::optional<std::string> place_fault(Vec3d origin, const Mat3d& step);

/// The message about frames of ultrasound that each have a place of their own.
std::string tracked_sequence();

}  // namespace trocar::geometry
