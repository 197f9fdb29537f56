// How near a mechanism's own links come to each other over the range of motion of its drives.
//
//   const ClearanceReport r = clearance_over_motion(m, {});
//   r.least;  r.pairs[0].first; r.pairs[0].handles;             // how near, which links, and where
//
// Parts that a joint or a closure connects are neighbours, and meant to touch there (link_pairs.hpp): they are
// reported only where they are in each other off the joint, and deeper than drawn. Another pair that overlaps in every
// pose is modelled so (hinged on one pin) and is reported separately. A mechanism without drives is led by the
// coordinates that its loops leave free. Poses of several drives are of Halton's sequence, until enough of them are
// within limits.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <trocar/kinematics/loops/close.hpp>

namespace trocar::studies {

struct ClearanceOptions {
  int steps = 200;                           ///< of a single drive's way
  int samples = 2000;                        ///< with several drives: poses within limits [Halton 1960]
  bool refine = true;                        ///< look about the nearest pose of each pair for a nearer one
  bool strict = false;                       ///< pairs that overlap in every pose count, too
  std::vector<std::pair<int, int>> ignored;  ///< links (into Mechanism::links)
  std::vector<double> drawn = {};            ///< LinkPairs::drawn() of another version; empty: of the start
};

struct PairClearance {
  int first = 0, second = 0;    ///< into Mechanism::links
  double least = 0, most = 0;   ///< [m], below 0: in each other; of neighbours: by how much deeper than drawn
  std::vector<double> handles;  ///< (drives) where it is least
  std::vector<double> curve;    ///< (poses of a single drive) NaN where the loops stay open
  bool beside_joint = false;    ///< they are neighbours
  bool always() const noexcept { return most < 0; }
};

struct ClearanceReport {
  std::vector<PairClearance> pairs;   ///< the nearest first; without those that always overlap
  std::vector<PairClearance> joined;  ///< these
  double least = 0;                   ///< of `pairs`; without any: infinite
  int poses = 0, reached = 0;         ///< tried; of them closed and within limits, and looked at
  double path = 0;                    ///< of the frame that is followed, with one drive [m]
  std::vector<std::string> drives;    ///< what leads, by name
  std::vector<double> handles;        ///< (poses) with one drive
  double reached_share() const noexcept { return poses > 0 ? double(reached) / poses : 0; }
};

/// @param follow  a frame whose way is measured, or -1
/// @throws std::invalid_argument where the start does not close
ClearanceReport clearance_over_motion(const kinematics::Mechanism& m, const ClearanceOptions& options, int follow = -1);

}  // namespace trocar::studies
