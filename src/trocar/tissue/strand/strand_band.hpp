// Small pieces that a strand's builder and its step share: geometry of the chain, and adding terms to the band matrix.
// A term is a weighted sum of up to three neighbouring nodes, q = sum c_j x_j, with a symmetric 3x3 stiffness; it adds
// c_i c_j S to the block (i, j).
#pragma once

#include <vector>

#include <trocar/numerics/banded.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::tissue {

inline constexpr int kStrandBand = 8;  ///< diagonals below the main one: three nodes of three coordinates couple
inline constexpr int kStrandReach = 2 * kStrandBand + 3;  ///< columns that the rows of one node touch
inline constexpr double kBendStencil[3] = {1, -2, 1};

/// Symmetric 3x3.
struct Sym3 {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  Vec3d operator*(Vec3d v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
};
inline Sym3 isotropic(double k) { return {k, k, k, 0, 0, 0}; }
/// k n n^T
inline Sym3 along(double k, Vec3d n) {
  return {k * n.x * n.x, k * n.y * n.y, k * n.z * n.z, k * n.x * n.y, k * n.x * n.z, k * n.y * n.z};
}
/// k (1 - n n^T)
inline Sym3 across(double k, Vec3d n) {
  const Sym3 a = along(-k, n);
  return {k + a.xx, k + a.yy, k + a.zz, a.xy, a.xz, a.yz};
}
inline Sym3 operator+(Sym3 a, Sym3 b) {
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
}

inline Vec3d second_difference(const std::vector<Vec3d>& x, int i) { return x[i - 1] - 2.0 * x[i] + x[i + 1]; }
/// Direction of the chain at an inner node.
inline Vec3d chain_direction(const std::vector<Vec3d>& x, int i, Vec3d fallback) {
  return normalised(x[i + 1] - x[i - 1], fallback);
}

/// The smallest rotation that takes the unit vector a to the unit vector b, applied to r. Fades out where b is nearly
/// -a, where no smallest rotation is.
inline Vec3d turned(Vec3d a, Vec3d b, Vec3d r) {
  const Vec3d w = cross(a, b);
  const double c = 1 + dot(a, b);
  return r + cross(w, r) + (1 / (c > 0.05 ? c : 0.05)) * cross(w, cross(w, r));
}
/// A director across a, carried without twist to one across b; unit.
inline Vec3d carried(Vec3d a, Vec3d b, Vec3d director) {
  const Vec3d d = turned(a, b, director), flat = d - dot(d, b) * b;
  const double size = length(flat);
  return size > 1e-30 ? flat / size : any_perpendicular(b);
}

inline void add_term(std::vector<double>& a, int first, const double* c, int count, const Sym3& s) {
  const double block[3][3] = {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}};
  for (int q = 0; q < count; ++q) {
    for (int j = 0; j < 3; ++j) {
      const int diagonal = 3 * (first + q) + j;
      double* const column = a.data() + numerics::band_at(kStrandBand, diagonal, diagonal);
      for (int i = j; i < 3; ++i) column[i - j] += c[q] * c[q] * block[i][j];
      for (int p = q + 1; p < count; ++p)
        for (int i = 0; i < 3; ++i) column[3 * (p - q) + i - j] += c[p] * c[q] * block[i][j];
    }
  }
}

/// Entry (row, column) of the symmetric band matrix, 0 outside the band.
inline double band_entry(const std::vector<double>& a, int row, int column) {
  const int low = row < column ? row : column, high = row < column ? column : row;
  return high - low > kStrandBand ? 0.0 : a[numerics::band_at(kStrandBand, high, low)];
}

/// Makes `value` the solution at a node: its columns go to the right side, its diagonal becomes 1.
inline void prescribe(std::vector<double>& a, std::vector<double>& rhs, int nodes, int node, Vec3d value) {
  const int rows = 3 * nodes;
  for (int axis = 0; axis < 3; ++axis) {
    const int r = 3 * node + axis;
    const int first = r > kStrandBand ? r - kStrandBand : 0, last = r + kStrandBand < rows ? r + kStrandBand : rows - 1;
    for (int j = first; j <= last; ++j) {
      double& entry = a[j <= r ? numerics::band_at(kStrandBand, r, j) : numerics::band_at(kStrandBand, j, r)];
      rhs[j] -= entry * value[axis];
      entry = 0;
    }
    a[numerics::band_at(kStrandBand, r, r)] = 1;
  }
  for (int axis = 0; axis < 3; ++axis) rhs[3 * node + axis] = value[axis];
}

}  // namespace trocar::tissue
