// B-spline and NURBS curves and surfaces: evaluation with derivatives, and the C2 cubic through given points.
//
//   const NurbsCurve tube = interpolated(points);          // natural cubic by chord length, parameter 0 .. 1
//   const CurvePoint at = tube.at(0.25);                   // at.point, at.first, at.second (per unit of parameter)
//   const NurbsCurve ring = interpolated_closed(points);   // periodic
//
// One representation serves all: clamped curves repeat their end knots, periodic ones repeat their first `degree`
// control points at the end and wrap the parameter. [Piegl & Tiller 1997, The NURBS Book, chapters 2-4, 9]
// Evaluation is noexcept and does not allocate; building throws std::invalid_argument.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry {

inline constexpr int kMaxDegree = 7;

/// The degree + 1 basis functions that do not vanish at a parameter, and their derivatives.
struct Basis {
  int first = 0;                         ///< index of the first of them
  double value[3][kMaxDegree + 1] = {};  ///< [derivative 0..2][k]: of function first + k
};
/// u is brought into the domain [knots[degree], knots[size - 1 - degree]] first.
Basis basis_functions(std::span<const double> knots, int degree, double u) noexcept;

struct CurvePoint {
  Vec3d point, first, second;
};

struct NurbsCurve {
  int degree = 3;
  bool periodic = false;
  std::vector<double> knots;    ///< ascending, control.size() + degree + 1
  std::vector<Vec3d> control;   ///< periodic: the last `degree` repeat the first
  std::vector<double> weights;  ///< > 0, one per control point; empty: all 1

  double start() const noexcept { return knots[degree]; }
  double end() const noexcept { return knots[knots.size() - 1 - degree]; }
  Vec3d point(double u) const noexcept { return at(u).point; }
  CurvePoint at(double u) const noexcept;  ///< u is clamped, or wrapped if periodic
};

/// Uniform cubic with the given control points, parameter 0 .. 1: starts in the first, ends in the last (at least 4).
NurbsCurve clamped_cubic(std::span<const Vec3d> control);
/// Closed uniform cubic with the given control points (at least 3), parameter 0 .. 1.
NurbsCurve periodic_cubic(std::span<const Vec3d> control);

/// Parameters 0 .. 1 in proportion to the length of the chords between the points (closed: the last chord, back to the
/// first point, is counted too and ends at 1).
std::vector<double> chord_parameters(std::span<const Vec3d> points, bool closed = false);

/// Derivatives by the parameter that the curve is to have at its ends; without one the second derivative is 0 there.
struct EndSlopes {
  std::optional<Vec3d> start, end;
};
/// The C2 cubic through the points (at least 2) at the given ascending parameters.
NurbsCurve interpolated(std::span<const Vec3d> points, std::span<const double> parameters,
                        const EndSlopes& slopes = {});
/// The same by chord length.
NurbsCurve interpolated(std::span<const Vec3d> points);
/// The closed C2 cubic through the points (at least 3, the first not repeated), which are passed at the given ascending
/// parameters; after `period` it is back at the first.
NurbsCurve interpolated_closed(std::span<const Vec3d> points, std::span<const double> parameters, double period);
NurbsCurve interpolated_closed(std::span<const Vec3d> points);

struct SurfacePoint {
  Vec3d point, du, dv;
  Vec3d normal() const noexcept { return normalised(cross(du, dv), Vec3d{}); }
};

struct NurbsSurface {
  int degree_u = 3, degree_v = 3;
  bool periodic_u = false, periodic_v = false;
  std::vector<double> knots_u, knots_v;
  int count_u = 0, count_v = 0;  ///< control points each way
  std::vector<Vec3d> control;    ///< of (i, j) at i + count_u j
  std::vector<double> weights;   ///< the same order; empty: all 1

  double start_u() const noexcept { return knots_u[degree_u]; }
  double end_u() const noexcept { return knots_u[knots_u.size() - 1 - degree_u]; }
  double start_v() const noexcept { return knots_v[degree_v]; }
  double end_v() const noexcept { return knots_v[knots_v.size() - 1 - degree_v]; }
  Vec3d point(double u, double v) const noexcept { return at(u, v).point; }
  SurfacePoint at(double u, double v) const noexcept;  ///< each clamped, or wrapped if periodic
};

}  // namespace trocar::geometry
