// Dimensions changed within their bounds until a mechanism's links keep clear of each other over the whole motion,
// while a frame's range stays: a penalty on what is missing, searched by a pattern [Hooke & Jeeves 1961], which needs
// no slopes and always goes the same way. Where one start ends in a corner, others follow from Halton's sequence.
//
// The end of a single drive's way stays where it is: jaws that close still do, and no further (end_of_way.hpp). Where
// that end is a parameter of its own, it follows from the others. Values are rounded as drawings have them, to a
// micrometre and a thousandth of a degree, and judged so.
//
//   const OptimiseResult r = optimise(m, {.clearance = 2e-4, .follow = tip});
//   r.free;  m.with(r.values);
#pragma once

#include <string>
#include <vector>

#include <trocar/studies/clearance.hpp>

namespace trocar::studies {

struct OptimiseOptions {
  double clearance = 2e-4;                              ///< wished for [m]
  int follow = -1;                                      ///< frame whose range is kept; -1: none is
  double keep = 0.95;                                   ///< share of its range as it was, at least
  double most = 1e300;                                  ///< and at most
  int starts = 6;                                       ///< at most
  int evaluations = 4000;                               ///< at most, of all starts
  ClearanceOptions sweep = {60, 400, false, true, {}};  ///< while searching
};

struct OptimiseResult {
  std::vector<int> parameters;               ///< that may change
  std::vector<double> values;                ///< (all parameters of the mechanism)
  ClearanceReport before, after;             ///< with all of the clearance's own resolution
  double range_before = 0, range_after = 0;  ///< of the frame: way [m] with one drive, else volume [m^3]
  double end_off = 0;                        ///< how far the end of the drive's way is from where it was [m]
  int evaluations = 0, starts = 0;
  bool free = false;            ///< the wish is met, range and end are kept, and every pose within limits is as before
  std::vector<double> history;  ///< (evaluations) the best penalty so far
};

/// @throws std::invalid_argument where no parameter has bounds, or the start does not close
OptimiseResult optimise(const kinematics::Mechanism& m, const OptimiseOptions& options,
                        const ClearanceOptions& judge = {});

}  // namespace trocar::studies
