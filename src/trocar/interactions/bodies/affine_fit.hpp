// Weights of a few nodes about a place that give the place for every affine motion of them.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <trocar/numerics/vec3.hpp>

namespace trocar::interactions {

inline constexpr int kRowNodes = 8;  ///< of a row of W that a point has with it

/// The nearest nodes to a place, nearest first.
struct NearNodes {
  std::array<std::int32_t, kRowNodes> node{};
  std::array<double, kRowNodes> square{};  ///< of the distance [m^2]
  int count = 0;

  void offer(std::int32_t n, double d2) noexcept;
};

/// In tissue that is crushed the nodes about a place lie all but in a plane, as those of a sheet always do, and what
/// they do across it would count a hundredfold: it counts the less, then, the more that is.
/// @param at      (count <= kRowNodes) where the nodes are [m]
/// @param weight  out: sum 1, sum of magnitudes at most 8
/// @return are there weights? If not there is nothing to go by but the nearest node
bool fit_affine(std::span<const Vec3d> at, Vec3d place, std::span<float> weight) noexcept;

}  // namespace trocar::interactions
