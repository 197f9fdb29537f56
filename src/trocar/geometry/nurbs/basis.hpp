// The basis functions of a B-spline at a parameter: the degree + 1 that do not vanish there, with all derivatives.
//
//   BasisRow n;
//   const int span = span_of(knots, u);
//   basis_values(knots, span, u, n);              // n[k] is function span - degree + k
//
// noexcept, without allocation.
#pragma once

#include <array>

#include <trocar/geometry/nurbs/knots.hpp>

namespace trocar::geometry::nurbs {

using BasisRow = std::array<double, kHighestDegree + 1>;  ///< the first degree + 1 of them are in use

/// The functions span - degree .. span. They sum to 1, none is negative.  [PT97 A2.2]
void basis_values(const Knots& knots, int span, double u, BasisRow& values) noexcept;

/// Derivatives 0 .. order by u; those above the degree are 0.  [PT97 A2.3]
/// @param values  out: order + 1 rows, the d-th derivatives in row d
void basis_derivatives(const Knots& knots, int span, double u, int order, BasisRow* values) noexcept;

/// One function alone, wherever it lives; 0 outside of its support.  [PT97 A2.4]
/// @param function 0 .. functions() - 1. At the domain's end the last one of a clamped spline is 1.
double basis_function(const Knots& knots, int function, double u) noexcept;

/// Functions and derivatives at a parameter anywhere (clamped or wrapped into the domain first), up to the second.
struct Basis2 {
  int first = 0;        ///< the first function that does not vanish
  BasisRow value[3]{};  ///< [derivative][k]: of function first + k
};
Basis2 basis_at(const Knots& knots, double u, int order = 2) noexcept;

}  // namespace trocar::geometry::nurbs
