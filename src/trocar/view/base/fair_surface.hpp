// The smoothest values on a net of points that pass at given points: how a drawn surface continues beyond the one
// that is there, without a crease.
//   const std::vector<double> z = fairest(neighbours, wished, weight);
#pragma once

#include <span>
#include <vector>

namespace trocar::view {

inline constexpr double kHeldFast = 1;  ///< a weight, see below

/// Minimises sum (L z)^2 + sum weight (z - wished)^2, L z_i = mean of its neighbours - z_i: a thin plate on springs.
/// A weight w lets the plate bend within h / (2 w^(1/4)), h the distance of neighbours.
/// @param neighbours (n) of every point; @param weight (n) > 0 somewhere, kHeldFast holds it
/// @return (n), after at most `passes` conjugate gradients from `wished`
std::vector<double> fairest(const std::vector<std::vector<int>>& neighbours, std::span<const double> wished,
                            std::span<const double> weight, int passes = 400);

}  // namespace trocar::view
