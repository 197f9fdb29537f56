// Rational tensor product B-spline surfaces: points, partial derivatives, normals.
//
//   const Surface ball = sphere({0, 0, 0}, 0.03);                   // nurbs_shapes/surface_makers.hpp
//   const SurfaceJet at = jet(ball, 0.25, 0.5);                     // at.point, at.du, at.dv, at.duu, ...
//   const Vec3d n = normal(ball, 0.0, 0.0);                         // at the pole, too
//
// As curve.hpp has it: plain data, valid ones taken for granted by what evaluates. Normals are du x dv. What this
// library makes has them outwards, u around and v along.
#pragma once

#include <string>
#include <vector>

#include <trocar/geometry/nurbs/knots.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry::nurbs {

struct Surface {
  Knots u, v;
  std::vector<Vec3d> points;    ///< control points, (i, j) at i + u.points() j
  std::vector<double> weights;  ///< > 0, in the same order; empty: all 1

  int index(int i, int j) const noexcept { return i + u.points() * j; }
  double weight(int index_) const noexcept { return weights.empty() ? 1.0 : weights[index_]; }
};

/// What is wrong with it; empty: nothing.
std::string fault_in(const Surface& surface);
/// @throws std::invalid_argument: `who`, and what fault_in says
void require_valid(const Surface& surface, const char* who);

/// Sum of N_i M_j w_ij P_ij over sum of N_i M_j w_ij.  [PT97 eq.4.11]
Vec3d point(const Surface& surface, double u, double v) noexcept;

struct SurfaceJet {
  Vec3d point, du, dv, duu, duv, dvv;
};
SurfaceJet jet(const Surface& surface, double u, double v) noexcept;
/// That of the polynomial piece of two spans: at a knot, from the side on which the span is.
SurfaceJet jet_in_spans(const Surface& surface, int span_u, int span_v, double u, double v) noexcept;

/// Derivatives k times by u and l times by v, k + l <= order: result[k][l].  [PT97 A3.6] [PT97 A4.4]
std::vector<std::vector<Vec3d>> derivatives(const Surface& surface, double u, double v, int order);

/// Unit normal along du x dv. Where a derivative vanishes, as at a pole, or both are parallel: the limit from inside of
/// the domain (our estimate); 0 only where there is none.
Vec3d normal(const Surface& surface, double u, double v) noexcept;

struct Curvatures {
  double gauss = 0.0;  ///< [1/m^2]
  double mean = 0.0;   ///< [1/m]; above 0 where the surface bends towards its normal
};
/// 0 where du x dv vanishes.
Curvatures curvatures(const SurfaceJet& jet) noexcept;

}  // namespace trocar::geometry::nurbs
