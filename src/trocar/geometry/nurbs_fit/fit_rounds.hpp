// Steps 2 and 3 of fit.hpp, in turns.
#pragma once

#include <trocar/geometry/nurbs_fit/samples.hpp>
#include <trocar/geometry/nurbs_fit/surface_system.hpp>

namespace trocar::geometry::nurbs {

struct FitRounds {
  double smoothing = 0.0;           ///< [m]
  double way_u = 0.0, way_v = 0.0;  ///< of the surface along its directions [m]
  int rounds = 10;
  int done = 0;  ///< out
};
/// Until a round makes the mean square better by less than a thousandth. The samples' parameters are changed.
Surface fit_in_rounds(const Unknowns& unknowns, Samples& samples, FitRounds& rounds);

}  // namespace trocar::geometry::nurbs
