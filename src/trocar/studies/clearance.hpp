// How near a mechanism's own links come to each other over the range of motion of its drives.
//
//   const ClearanceReport r = clearance_over_motion(m, {});
//   r.least;  r.pairs[0].first; r.pairs[0].handles;             // how near, which links, and where
//
// Links that joints without freedom keep together are one part. Parts that a joint or a closure connects are
// neighbours, and meant to touch: they are not looked at. A pair that overlaps in every pose is modelled so (hinged on
// one pin) and is reported separately. A mechanism with neither drives nor loops is controlled by all coordinates that
// have limits.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <trocar/kinematics/loops/close.hpp>

namespace trocar::studies {

struct ClearanceOptions {
  int steps = 200;                           ///< of a single drive's way
  int samples = 2000;                        ///< with several drives: poses, of Halton's sequence [Halton 1960]
  bool refine = true;                        ///< look about the nearest pose of each pair for a nearer one
  bool strict = false;                       ///< pairs that overlap in every pose count, too
  std::vector<std::pair<int, int>> ignored;  ///< links (into Mechanism::links)
};

struct PairClearance {
  int first = 0, second = 0;    ///< into Mechanism::links
  double least = 0, most = 0;   ///< [m], below 0: in each other
  std::vector<double> handles;  ///< (drives) where it is least
  std::vector<double> curve;    ///< (poses of a single drive) NaN where the loops stay open
  bool always() const noexcept { return most < 0; }
};

struct ClearanceReport {
  std::vector<PairClearance> pairs;   ///< the nearest first; without those that always overlap
  std::vector<PairClearance> joined;  ///< these
  double least = 0;                   ///< of `pairs`; without any: infinite
  int poses = 0, reached = 0;         ///< looked at; of them closed and within limits
  double path = 0;                    ///< of the frame that is followed, with one drive [m]
  std::vector<std::string> drives;    ///< what leads, by name
  std::vector<double> handles;        ///< (poses) with one drive
  double reached_share() const noexcept { return poses > 0 ? double(reached) / poses : 0; }
};

/// @param follow  a frame whose way is measured, or -1
/// @throws std::invalid_argument where the start does not close
ClearanceReport clearance_over_motion(const kinematics::Mechanism& m, const ClearanceOptions& options, int follow = -1);

}  // namespace trocar::studies
