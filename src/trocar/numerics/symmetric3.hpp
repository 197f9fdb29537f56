// Principal axes: eigenvalues and eigenvectors of a symmetric 3x3 matrix, by Jacobi's rotations in a fixed order.
//   const Principal axes = principal(covariance);   // axes.value[0] >= [1] >= [2], axes.axis[k] of unit length
// [Golub & Van Loan 2013, Matrix Computations, section 8.5]
#pragma once

#include <trocar/numerics/mat3.hpp>

namespace trocar::numerics {

struct Principal {
  double value[3]{};  ///< falling
  Vec3d axis[3];      ///< right-handed; the first two point to the side of their largest coordinate
};
/// @param a symmetric; only its upper half is looked at
Principal principal(const Mat3d& a) noexcept;

/// Of points about their mean: mean of (x - mean) (x - mean)^T.
template <class Points>
Mat3d covariance(const Points& points, Vec3d& mean) {
  mean = {};
  if (points.empty()) return {};
  for (const Vec3d& p : points) mean += p;
  mean = mean / double(points.size());
  Mat3d sum;
  for (const Vec3d& p : points) sum = sum + outer(p - mean, p - mean);
  return (1.0 / double(points.size())) * sum;
}

}  // namespace trocar::numerics
