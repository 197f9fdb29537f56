// 4x4 matrices as OpenGL wants them (column major), for placing meshes and projecting them. Never used by the step.
#pragma once

#include <array>

#include <trocar/numerics/vec3.hpp>

namespace trocar::render {

struct Mat4 {
  std::array<float, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};  ///< m[4 * column + row]

  friend bool operator==(const Mat4& a, const Mat4& b) { return a.m == b.m; }
};

Mat4 operator*(const Mat4& a, const Mat4& b);

/// Rotation (columns = images of the axes, may hold a scale) followed by translation [m].
Mat4 placement(const Mat3f& rotation, Vec3f translation);
/// World -> eye for a camera whose rotation columns are right, up and backward.
Mat4 view_matrix(const Mat3f& rotation, Vec3f position);
/// Eye -> clip. @param vertical_fov [rad], aspect = width / height, 0 < near < far [m]
/// @param shift  tangent of how far to the right the picture's middle looks
Mat4 perspective(float vertical_fov, float aspect, float near_plane, float far_plane, float shift = 0);

Vec3f transform_point(const Mat4& a, Vec3f p);
Vec3f transform_direction(const Mat4& a, Vec3f v);
bool is_finite(const Mat4& a);

}  // namespace trocar::render
