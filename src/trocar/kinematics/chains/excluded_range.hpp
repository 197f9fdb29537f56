// Coordinates that follow another (couplings, mimicked joints) and cannot go where it leads them: their own limits
// exclude a part of the way, or all of it, and with it a part of the leader's range. Where several lead together,
// limits say which of their combinations there are, so that nothing is wrong with them.
#pragma once

#include <string>
#include <vector>

#include <trocar/kinematics/chains/mechanism.hpp>

namespace trocar::kinematics {

struct ExcludedRange {
  int coordinate = 0;        ///< into q
  double low = 0, high = 0;  ///< where it is led [rad, m]
  int leader = -1;           ///< into q
};

/// Of all coordinates that follow one other. Leaders go as far as their drives, else as their limits; one without
/// either says nothing, and neither does one that loops move.
std::vector<ExcludedRange> excluded_ranges(const Mechanism& m);

/// What is excluded, and what to do.
std::string words(const Mechanism& m, const ExcludedRange& range);

}  // namespace trocar::kinematics
