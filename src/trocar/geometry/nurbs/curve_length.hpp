// Length of curves by quadrature, and the parameter after a given way.
//
//   const double whole = length(curve);                             // [m]
//   const double middle = parameter_after(curve, 0.5 * whole);
#pragma once

#include <vector>

#include <trocar/geometry/nurbs/curve.hpp>

namespace trocar::geometry::nurbs {

/// From a to b [m], a <= b in the domain: five-point Gauss quadrature in each span, halved until both halves together
/// say the same to a share of 1e-12 of the control polygon's length.
double length(const Curve& curve, double a, double b);
double length(const Curve& curve);
/// Where the way s [m] from the start ends; clamped to the domain.
double parameter_after(const Curve& curve, double s);
/// `count` parameters (at least 2) at equal ways, first and last included.
std::vector<double> parameters_by_length(const Curve& curve, int count);

}  // namespace trocar::geometry::nurbs
