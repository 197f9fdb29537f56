// Curves that pass near many points with few control points.
//
//   const CurveFit fit = fit_curve(points, 8);                      // eight control points, least squares
//   const CurveFit close = fit_curve_within(points, 0.0005);        // as many as it takes for half a millimetre
//
// Ends of open curves are the first and the last point exactly. Each round solves for the control points and then gives
// each point the parameter of the curve's place that is nearest.  [PT97 eq.9.69] [Hoschek 1988]
#pragma once

#include <span>
#include <vector>

#include <trocar/geometry/nurbs/curve.hpp>
#include <trocar/geometry/nurbs_shapes/interpolate.hpp>

namespace trocar::geometry::nurbs {

struct CurveFitOptions {
  int degree = 3;
  bool closed = false;  ///< back from the last point to the first; periodic
  Slopes slopes;        ///< derivatives at the ends of an open curve, parameter 0 .. 1 [m]
  int rounds = 6;       ///< at most
};

struct CurveFit {
  Curve curve;
  std::vector<double> residuals;  ///< of each point [m]
  double rms = 0.0, greatest = 0.0;
};

/// @param control_points more than the degree, at most as many as points. @throws std::invalid_argument for other
/// numbers, and for points that coincide with their neighbours or are not numbers
CurveFit fit_curve(std::span<const Vec3d> points, int control_points, const CurveFitOptions& options = {});
/// The same with the fewest control points, from the fewest on and with a knot more in each span that has a point
/// further away than `tolerance` [m], until none is or there are as many control points as points; greatest says which.
CurveFit fit_curve_within(std::span<const Vec3d> points, double tolerance, const CurveFitOptions& options = {});

}  // namespace trocar::geometry::nurbs
