// Rational B-spline curves: points, derivatives to any order, tangent and curvature.
//
//   const Curve ring = circle({0, 0, 0}, {0, 0, 1}, 0.02);         // nurbs_shapes/curve_makers.hpp
//   const CurveJet at = jet(ring, 0.25);                           // at.point, at.first, at.second
//
// A curve is plain data; after changes by hand ask fault_in before it is used. What evaluates takes valid curves
// for granted, is noexcept and does not allocate, unless it returns a vector. Lengths in metres; derivatives are by the
// parameter, which has no unit.
#pragma once

#include <string>
#include <vector>

#include <trocar/geometry/nurbs/knots.hpp>
#include <trocar/geometry/nurbs/row.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry::nurbs {

struct Curve {
  Knots knots;
  std::vector<Vec3d> points;    ///< control points; knots.points() of them
  std::vector<double> weights;  ///< > 0, one per control point; empty: all 1

  double weight(int i) const noexcept { return weights.empty() ? 1.0 : weights[i]; }
};

/// What is wrong with it: its knots, how many points and weights there are, numbers that are none; empty: nothing.
std::string fault_in(const Curve& curve);
/// @throws std::invalid_argument: `who`, and what fault_in says
void require_valid(const Curve& curve, const char* who);

/// Sum of N_i w_i P_i over sum of N_i w_i.  [PT97 eq.4.1]
Vec3d point(const Curve& curve, double u) noexcept;

struct CurveJet {
  Vec3d point, first, second;
};
CurveJet jet(const Curve& curve, double u) noexcept;
/// That of the span's polynomial piece: at a knot, from the side on which the span is.
CurveJet jet_in_span(const Curve& curve, int span, double u) noexcept;

/// Derivatives 0 .. order.  [PT97 A3.2] [PT97 A4.2]
std::vector<Vec3d> derivatives(const Curve& curve, double u, int order);

/// Unit tangent, also where the first derivative vanishes but a higher one (up to the degree) does not; else 0.
Vec3d tangent(const Curve& curve, double u);
/// Curvature vector [1/m]: towards the centre, as long as 1 / radius; 0 where the first derivative vanishes.
Vec3d curvature(const Curve& curve, double u) noexcept;

/// Weighted control points and back; weights that are all 1 are left out.
Row row_of(const Curve& curve);
Curve curve_of(const Row& row);

}  // namespace trocar::geometry::nurbs
