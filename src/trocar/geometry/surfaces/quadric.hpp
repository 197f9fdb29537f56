// The sum of squared distances from planes, as one function of the place: what a vertex costs that stands for many
// triangles. [Garland & Heckbert 1997, Surface simplification using quadric error metrics]
#pragma once

#include <algorithm>

#include <trocar/numerics/mat3.hpp>

namespace trocar::geometry {

/// Squared distances from planes, weighed by area: x' A x + 2 b x + c, A symmetric. [Garland & Heckbert 1997, sec. 5]
struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0, bx = 0, by = 0, bz = 0, c = 0, area = 0;

  void add_plane(Vec3d n, double d, double w) {
    xx += w * n.x * n.x, xy += w * n.x * n.y, xz += w * n.x * n.z;
    yy += w * n.y * n.y, yz += w * n.y * n.z, zz += w * n.z * n.z;
    bx += w * d * n.x, by += w * d * n.y, bz += w * d * n.z, c += w * d * d, area += w;
  }
  void add(const Quadric& q) {
    xx += q.xx, xy += q.xy, xz += q.xz, yy += q.yy, yz += q.yz, zz += q.zz;
    bx += q.bx, by += q.by, bz += q.bz, c += q.c, area += q.area;
  }
  /// Their mean [m^2].
  double at(Vec3d p) const {
    const double sum = p.x * (xx * p.x + 2 * xy * p.y + 2 * xz * p.z) + p.y * (yy * p.y + 2 * yz * p.z) +
                       zz * p.z * p.z + 2 * (bx * p.x + by * p.y + bz * p.z) + c;
    return area > 0 ? std::max(sum, 0.0) / area : 0;
  }
  /// Where it is least; false where the planes leave that open, as those of a flat or of a straight place do.
  bool least(Vec3d& place) const {
    const Mat3d a{{{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}}};
    const double size = (xx + yy + zz) / 3;
    if (!(determinant(a) > 1e-4 * size * size * size)) return false;
    place = -(inverse(a) * Vec3d{bx, by, bz});
    return finite(place);
  }
};

}  // namespace trocar::geometry
