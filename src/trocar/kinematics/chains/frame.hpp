// A frame in space: where its origin lies and how its axes are turned. a * b is b, given in a, seen from where a is.
#pragma once

#include <trocar/numerics/mat3.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/numerics/quat.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::kinematics {

struct Frame {
  Mat3d r = Mat3d::identity();  ///< columns: its axes
  Vec3d p;                      ///< its origin [m]

  friend Frame operator*(const Frame& a, const Frame& b) { return {a.r * b.r, a.r * b.p + a.p}; }
  friend Vec3d operator*(const Frame& a, Vec3d v) { return a.r * v + a.p; }
};

inline Frame inverse(const Frame& a) {
  const Mat3d t = transposed(a.r);
  return {t, -(t * a.p)};
}
/// The turn about a unit axis by the angle with this sine and cosine.
inline Mat3d turn_about(Vec3d k, double sine, double cosine) {
  const double v = 1 - cosine;
  return {{{cosine + v * k.x * k.x, v * k.x * k.y - sine * k.z, v * k.x * k.z + sine * k.y},
           {v * k.x * k.y + sine * k.z, cosine + v * k.y * k.y, v * k.y * k.z - sine * k.x},
           {v * k.x * k.z - sine * k.y, v * k.y * k.z + sine * k.x, cosine + v * k.z * k.z}}};
}
inline Mat3d turn_about(Vec3d unit_axis, double angle) {
  return turn_about(unit_axis, portable::sin(angle), portable::cos(angle));
}
/// About the fixed x, then the fixed y, then the fixed z axis, as URDF's roll, pitch, yaw [rad].
inline Mat3d turn_xyz(Vec3d angles) {
  Mat3d r = angles.x == 0 ? Mat3d::identity() : turn_about({1, 0, 0}, angles.x);
  if (angles.y != 0) r = turn_about({0, 1, 0}, angles.y) * r;
  if (angles.z != 0) r = turn_about({0, 0, 1}, angles.z) * r;
  return r;
}
/// The turn from `from` to `to` as a vector, in the axes of space [rad].
inline Vec3d turn_between(const Mat3d& from, const Mat3d& to) {
  return rotation_vector(quat_from_mat3(to * transposed(from)));
}

}  // namespace trocar::kinematics
