// Small vectors, matrices and quaternions for the step: plain IEEE arithmetic in a fixed order, no SIMD, no FMA.
#pragma once

#include <cmath>

namespace trocar {

template <class T>
struct Vec3 {
  T x{}, y{}, z{};

  constexpr T& operator[](int i) { return i == 0 ? x : (i == 1 ? y : z); }
  constexpr T operator[](int i) const { return i == 0 ? x : (i == 1 ? y : z); }

  constexpr Vec3& operator+=(Vec3 b) {
    x += b.x;
    y += b.y;
    z += b.z;
    return *this;
  }
  constexpr Vec3& operator-=(Vec3 b) {
    x -= b.x;
    y -= b.y;
    z -= b.z;
    return *this;
  }
  constexpr Vec3& operator*=(T s) {
    x *= s;
    y *= s;
    z *= s;
    return *this;
  }
  friend constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vec3 operator*(T s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
  friend constexpr Vec3 operator*(Vec3 a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  friend constexpr Vec3 operator/(Vec3 a, T s) { return {a.x / s, a.y / s, a.z / s}; }
  friend constexpr bool operator==(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
};

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

template <class T>
constexpr T dot(Vec3<T> a, Vec3<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
T length(Vec3<T> a) {
  return std::sqrt(dot(a, a));
}
/// Unit vector along a, or `fallback` where a is (nearly) zero.
template <class T>
Vec3<T> normalised(Vec3<T> a, Vec3<T> fallback = {T(1), T(0), T(0)}) {
  const T n = length(a);
  return n > T(1e-30) ? a / n : fallback;
}
/// Some unit vector perpendicular to the unit vector n; continuous except at one direction.
template <class T>
Vec3<T> any_perpendicular(Vec3<T> n) {
  const Vec3<T> helper = std::fabs(n.x) < T(0.7) ? Vec3<T>{1, 0, 0} : Vec3<T>{0, 1, 0};
  return normalised(cross(n, helper));
}
template <class T>
bool finite(Vec3<T> a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
template <class U, class T>
constexpr Vec3<U> vec_cast(Vec3<T> a) {
  return {U(a.x), U(a.y), U(a.z)};
}

/// 3x3 matrix, row major: m[row][column].
template <class T>
struct Mat3 {
  T m[3][3]{};

  static constexpr Mat3 identity() { return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}; }
  static constexpr Mat3 from_columns(Vec3<T> a, Vec3<T> b, Vec3<T> c) {
    return {{{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}}};
  }
  constexpr Vec3<T> column(int j) const { return {m[0][j], m[1][j], m[2][j]}; }
  friend constexpr Vec3<T> operator*(const Mat3& a, Vec3<T> v) {
    return {a.m[0][0] * v.x + a.m[0][1] * v.y + a.m[0][2] * v.z, a.m[1][0] * v.x + a.m[1][1] * v.y + a.m[1][2] * v.z,
            a.m[2][0] * v.x + a.m[2][1] * v.y + a.m[2][2] * v.z};
  }
  friend constexpr Mat3 operator*(const Mat3& a, const Mat3& b) {
    Mat3 r;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) r.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j];
    return r;
  }
};
template <class T>
constexpr Mat3<T> transposed(const Mat3<T>& a) {
  return {{{a.m[0][0], a.m[1][0], a.m[2][0]}, {a.m[0][1], a.m[1][1], a.m[2][1]}, {a.m[0][2], a.m[1][2], a.m[2][2]}}};
}
using Mat3d = Mat3<double>;
using Mat3f = Mat3<float>;

}  // namespace trocar
