// What curves and surfaces share: faults of control points and weights, and the numbers in derivatives of quotients.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry::nurbs {

/// What is wrong with control points and weights of which `count` are expected; empty: nothing.
inline std::string fault_in_net(const std::vector<Vec3d>& points, const std::vector<double>& weights, int count) {
  if (static_cast<int>(points.size()) != count)
    return tr("the knots ask for {} control points, got {}", count, points.size());
  if (!weights.empty() && weights.size() != points.size())
    return tr("a weight for each of {} control points expected, got {}", count, weights.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!finite(points[i])) return tr("control point {} is not a number", i);
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (!(weights[i] > 0.0) || !std::isfinite(weights[i]))
      return tr("weight {} above 0 expected, got {}", i, weights[i]);
  return {};
}

/// Weights that are all 1, but for rounding, need not be stored.
inline void drop_plain_weights(std::vector<double>& weights) {
  for (double w : weights)
    if (std::fabs(w - 1.0) > 1e-14) return;
  weights.clear();
}

/// n over k
inline double binomial(int n, int k) noexcept {
  double result = 1.0;
  for (int i = 1; i <= k; ++i) result = result * (n - k + i) / i;
  return result;
}

}  // namespace trocar::geometry::nurbs
