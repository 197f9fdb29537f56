// Rotations as unit quaternions (w, x, y, z): rotate(q, v) turns v, and (a * b) turns by b first, then by a.
//   const Quatd q = quat_from_axis_angle(Vec3d{0, 0, 1}, portable::pi / 2);   // x -> y
// Angles in radians. Bits are the same everywhere: the only transcendentals are the portable ones, in double.
#pragma once

#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar {

template <class T>
struct Quat {
  T w{1}, x{}, y{}, z{};

  constexpr Vec3<T> vector() const { return {x, y, z}; }
  friend constexpr Quat operator*(Quat a, Quat b) {
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
  }
  friend constexpr Quat operator-(Quat a) { return {-a.w, -a.x, -a.y, -a.z}; }
  friend constexpr bool operator==(Quat a, Quat b) { return a.w == b.w && a.x == b.x && a.y == b.y && a.z == b.z; }
};
using Quatd = Quat<double>;
using Quatf = Quat<float>;

template <class T>
constexpr T dot(Quat<T> a, Quat<T> b) {
  return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
}
/// The inverse rotation of a unit quaternion.
template <class T>
constexpr Quat<T> conjugate(Quat<T> q) {
  return {q.w, -q.x, -q.y, -q.z};
}
/// Unit quaternion along q; the identity where q is (nearly) zero.
template <class T>
Quat<T> normalised(Quat<T> q) {
  const T n = std::sqrt(dot(q, q));
  if (!(n > T(1e-18))) return {};
  return {q.w / n, q.x / n, q.y / n, q.z / n};
}
/// v turned by the unit quaternion q.
template <class T>
constexpr Vec3<T> rotate(Quat<T> q, Vec3<T> v) {
  const Vec3<T> u = q.vector(), t = T(2) * cross(u, v);
  return v + q.w * t + cross(u, t);
}

/// Turn by `angle` [rad] about `axis` (any length; a zero axis gives no turn).
template <class T>
Quat<T> quat_from_axis_angle(Vec3<T> axis, T angle) {
  const Vec3<T> unit = normalised(axis, Vec3<T>{});
  const double half = 0.5 * double(angle);
  const Vec3<T> v = T(portable::sin(half)) * unit;
  if (unit == Vec3<T>{}) return {};
  return {T(portable::cos(half)), v.x, v.y, v.z};
}
/// The turn by the vector r: axis r, angle |r| [rad].
template <class T>
Quat<T> quat_from_rotation_vector(Vec3<T> r) {
  return quat_from_axis_angle(r, length(r));
}
/// The inverse of the above, with an angle in [0, pi].
template <class T>
Vec3<T> rotation_vector(Quat<T> q) {
  if (q.w < T(0)) q = -q;
  const double sine = double(length(q.vector()));
  if (!(sine > 1e-18)) return T(2) * q.vector();
  return T(2.0 * portable::atan2(sine, double(q.w)) / sine) * q.vector();
}
/// The shortest turn that takes direction `from` to direction `to` (any lengths; a half turn about some
/// perpendicular where they are opposite).
template <class T>
Quat<T> quat_from_two_vectors(Vec3<T> from, Vec3<T> to) {
  const Vec3<T> a = normalised(from), b = normalised(to, a);
  // Half the way from a to b: q = (a . h, a x h), exact also for large angles.
  const Vec3<T> sum = a + b;
  if (!(dot(sum, sum) > T(1e-12))) {
    const Vec3<T> axis = any_perpendicular(a);
    return {T(0), axis.x, axis.y, axis.z};
  }
  const Vec3<T> h = normalised(sum), v = cross(a, h);
  return normalised(Quat<T>{dot(a, h), v.x, v.y, v.z});
}

template <class T>
constexpr Mat3<T> to_mat3(Quat<T> q) {
  const T xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z, xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
  const T wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  return {{{1 - 2 * (yy + zz), 2 * (xy - wz), 2 * (xz + wy)},
           {2 * (xy + wz), 1 - 2 * (xx + zz), 2 * (yz - wx)},
           {2 * (xz - wy), 2 * (yz + wx), 1 - 2 * (xx + yy)}}};
}
/// The unit quaternion of a rotation matrix (w >= 0); divides by the largest component. [Shepperd 1978]
template <class T>
Quat<T> quat_from_mat3(const Mat3<T>& r) {
  const T trace = r.m[0][0] + r.m[1][1] + r.m[2][2];
  Quat<T> q;
  if (trace >= r.m[0][0] && trace >= r.m[1][1] && trace >= r.m[2][2]) {
    q = {1 + trace, r.m[2][1] - r.m[1][2], r.m[0][2] - r.m[2][0], r.m[1][0] - r.m[0][1]};
  } else if (r.m[0][0] >= r.m[1][1] && r.m[0][0] >= r.m[2][2]) {
    q = {r.m[2][1] - r.m[1][2], 1 + r.m[0][0] - r.m[1][1] - r.m[2][2], r.m[0][1] + r.m[1][0], r.m[0][2] + r.m[2][0]};
  } else if (r.m[1][1] >= r.m[2][2]) {
    q = {r.m[0][2] - r.m[2][0], r.m[0][1] + r.m[1][0], 1 + r.m[1][1] - r.m[0][0] - r.m[2][2], r.m[1][2] + r.m[2][1]};
  } else {
    q = {r.m[1][0] - r.m[0][1], r.m[0][2] + r.m[2][0], r.m[1][2] + r.m[2][1], 1 + r.m[2][2] - r.m[0][0] - r.m[1][1]};
  }
  q = normalised(q);
  return q.w < T(0) ? -q : q;
}

/// From a (t = 0) to b (t = 1) at constant angular speed, the short way round. [Shoemake 1985]
template <class T>
Quat<T> slerp(Quat<T> a, Quat<T> b, T t) {
  double c = double(dot(a, b));
  if (c < 0.0) {
    b = -b;
    c = -c;
  }
  double weight_a = 1.0 - double(t), weight_b = double(t);
  if (c < 0.9999) {  // closer than 1.6 degrees the chord is the arc to within 1e-5 of it
    const double angle = portable::acos(c), sine = portable::sin(angle);
    weight_a = portable::sin(weight_a * angle) / sine;
    weight_b = portable::sin(weight_b * angle) / sine;
  }
  const T p = T(weight_a), r = T(weight_b);
  return normalised(Quat<T>{p * a.w + r * b.w, p * a.x + r * b.x, p * a.y + r * b.y, p * a.z + r * b.z});
}

}  // namespace trocar
