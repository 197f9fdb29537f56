// Surfaces (without weights) by least squares: as near to given points at given parameters as their stiffness lets
// them.
//
//   SurfaceSystem system(sphere_unknowns(u, v));
//   for (...) system.add_point(u_k, v_k, x_k, share_k);
//   system.add_bending(smoothing, around, length);
//   const Surface s = system.solve();
//
// Minimised is sum of share |S(u, v) - x|^2 + l^4 (integral of |second derivatives by way|^2) / area, with the ways
// around and along taken as even: what is smaller than the length l is smoothed away. (Thin plate; [PT97 section 9.4]
// has the least squares.)
#pragma once

#include <vector>

#include <trocar/geometry/nurbs/surface.hpp>

namespace trocar::geometry::nurbs {

/// Control points as combinations of unknowns, which are numbered along v so that neighbours' numbers are near.
struct Unknowns {
  struct Part {
    int unknown;
    double factor;
  };
  Knots u, v;
  std::vector<std::vector<Part>> of_point;
  int count = 0;
};
/// Every control point for itself.
Unknowns free_unknowns(const Knots& u, const Knots& v);
/// u periodic, v clamped with a pole at both ends: each pole is one point, and the row next to it an ellipse's affine
/// image in a plane through it, so that the surface has a tangent plane there (our estimate).
Unknowns sphere_unknowns(const Knots& u, const Knots& v);

class SurfaceSystem {
 public:
  explicit SurfaceSystem(const Unknowns& unknowns);

  void add_point(double u, double v, Vec3d x, double share);
  /// @param smoothing l [m] @param way_u, way_v lengths of the surface along u and v [m]
  void add_bending(double smoothing, double way_u, double way_v);
  /// @throws std::runtime_error if points and bending leave something undetermined
  Surface solve();

 private:
  struct Entry {
    int unknown;
    double value;
  };
  // The unknowns' shares in a derivative (k by u, l by v) at a place.
  void row_at(double u, double v, int k, int l, std::vector<Entry>& row) const;
  void add_row(const std::vector<Entry>& row, Vec3d x, double share);

  const Unknowns& m_unknowns;
  int m_half;                    ///< bandwidth
  std::vector<double> m_a, m_b;  ///< normal matrix, numerics/banded.hpp; right hand sides, three a row
  std::vector<Entry> m_row;
};

}  // namespace trocar::geometry::nurbs
