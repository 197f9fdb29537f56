// Motions and wrenches of a rigid body as six numbers, and the symmetric positive definite matrices between them.
// Plain IEEE arithmetic in a fixed order.
#pragma once

#include <cmath>

#include <trocar/interactions/objects/rigid.hpp>

namespace trocar::interactions {

/// Of a force along `axis` at `arm` from the middle: dot with a motion is the speed of that point along the axis.
inline Vec6 wrench(Vec3d axis, Vec3d arm) noexcept {
  const Vec3d t = cross(arm, axis);
  return {axis.x, axis.y, axis.z, t.x, t.y, t.z};
}
inline double product(const Vec6& a, const Vec6& b) noexcept {
  double sum = 0;
  for (size_t i = 0; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}
inline Vec6 product(const Mat6& a, const Vec6& b) noexcept {
  Vec6 out;
  for (size_t i = 0; i < 6; ++i) out[i] = product(a[i], b);
  return out;
}
inline void add(Vec6& to, double s, const Vec6& v) noexcept {
  for (size_t i = 0; i < 6; ++i) to[i] += s * v[i];
}
/// a += s v v^T
inline void add_outer(Mat6& a, const Vec6& v, double s) noexcept {
  for (size_t i = 0; i < 6; ++i) add(a[i], s * v[i], v);
}
/// By Cholesky's factors.
inline Mat6 inverse_of(const Mat6& a) noexcept {
  Mat6 l{}, out{};
  for (size_t i = 0; i < 6; ++i)
    for (size_t j = 0; j <= i; ++j) {
      double sum = a[i][j];
      for (size_t k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      l[i][j] = i == j ? std::sqrt(sum) : sum / l[j][j];
    }
  for (size_t c = 0; c < 6; ++c) {
    Vec6 y{};
    for (size_t i = 0; i < 6; ++i) {
      double sum = i == c ? 1 : 0;
      for (size_t k = 0; k < i; ++k) sum -= l[i][k] * y[k];
      y[i] = sum / l[i][i];
    }
    for (size_t n = 6; n-- > 0;) {
      double sum = y[n];
      for (size_t k = n + 1; k < 6; ++k) sum -= l[k][n] * out[k][c];
      out[n][c] = sum / l[n][n];
    }
  }
  return out;
}

}  // namespace trocar::interactions
