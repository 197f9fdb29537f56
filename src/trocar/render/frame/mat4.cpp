#include <cmath>

#include <trocar/render/frame/mat4.hpp>

namespace trocar::render {

Mat4 operator*(const Mat4& a, const Mat4& b) {
  Mat4 r;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) {
      float sum = 0;
      for (int k = 0; k < 4; ++k) sum += a.m[4 * k + row] * b.m[4 * column + k];
      r.m[4 * column + row] = sum;
    }
  return r;
}

Mat4 placement(const Mat3f& rotation, Vec3f t) {
  const auto& r = rotation.m;
  return {{r[0][0], r[1][0], r[2][0], 0, r[0][1], r[1][1], r[2][1], 0, r[0][2], r[1][2], r[2][2], 0, t.x, t.y, t.z, 1}};
}

Mat4 view_matrix(const Mat3f& rotation, Vec3f position) {
  const Mat3f inverse = transposed(rotation);
  return placement(inverse, -(inverse * position));
}

Mat4 perspective(float vertical_fov, float aspect, float near_plane, float far_plane, float shift) {
  const float f = 1 / std::tan(vertical_fov / 2);
  const float depth = near_plane - far_plane;
  return {{f / aspect, 0, 0, 0, 0, f, 0, 0, f / aspect * shift, 0, (far_plane + near_plane) / depth, -1, 0, 0,
           2 * far_plane * near_plane / depth, 0}};
}

Vec3f transform_point(const Mat4& a, Vec3f p) { return transform_direction(a, p) + Vec3f{a.m[12], a.m[13], a.m[14]}; }

Vec3f transform_direction(const Mat4& a, Vec3f v) {
  return {a.m[0] * v.x + a.m[4] * v.y + a.m[8] * v.z, a.m[1] * v.x + a.m[5] * v.y + a.m[9] * v.z,
          a.m[2] * v.x + a.m[6] * v.y + a.m[10] * v.z};
}

bool is_finite(const Mat4& a) {
  for (float value : a.m)
    if (!std::isfinite(value)) return false;
  return true;
}

}  // namespace trocar::render
