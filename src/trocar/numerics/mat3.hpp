// More of 3x3 matrices: sums, determinant, inverse, outer product. Plain IEEE arithmetic in a fixed order.
#pragma once

#include <trocar/numerics/vec3.hpp>

namespace trocar {

template <class T>
constexpr Mat3<T> operator+(const Mat3<T>& a, const Mat3<T>& b) {
  Mat3<T> r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r.m[i][j] = a.m[i][j] + b.m[i][j];
  return r;
}
template <class T>
constexpr Mat3<T> operator-(const Mat3<T>& a, const Mat3<T>& b) {
  Mat3<T> r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r.m[i][j] = a.m[i][j] - b.m[i][j];
  return r;
}
template <class T>
constexpr Mat3<T> operator*(T s, const Mat3<T>& a) {
  Mat3<T> r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r.m[i][j] = s * a.m[i][j];
  return r;
}
/// a b^T
template <class T>
constexpr Mat3<T> outer(Vec3<T> a, Vec3<T> b) {
  return {{{a.x * b.x, a.x * b.y, a.x * b.z}, {a.y * b.x, a.y * b.y, a.y * b.z}, {a.z * b.x, a.z * b.y, a.z * b.z}}};
}
template <class T>
constexpr T determinant(const Mat3<T>& a) {
  return dot(a.column(0), cross(a.column(1), a.column(2)));
}
template <class T>
constexpr T trace(const Mat3<T>& a) {
  return a.m[0][0] + a.m[1][1] + a.m[2][2];
}
/// a^-1; infinities or NaN where a is singular (look at determinant() first).
template <class T>
constexpr Mat3<T> inverse(const Mat3<T>& a) {
  const Vec3<T> u = a.column(0), v = a.column(1), w = a.column(2);
  const Vec3<T> vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
  const T s = T(1) / dot(u, vw);
  return {{{s * vw.x, s * vw.y, s * vw.z}, {s * wu.x, s * wu.y, s * wu.z}, {s * uv.x, s * uv.y, s * uv.z}}};
}

}  // namespace trocar
