// In which order the inner nodes of an organ are eliminated: nested dissection in space [George 1973], by halves across
// the longest axis. What joins two halves comes after both; what is kept comes last of all.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/tissue/elastostatic/stiffness.hpp>

namespace trocar::tissue {

/// Nodes that are eliminated together, and those that have to do with them or with what was eliminated below, later.
struct FrontNodes {
  std::vector<int> own;       ///< in the order of elimination
  std::vector<int> border;    ///< by their places
  std::vector<int> children;  ///< fronts, ascending; all before this one
};

struct Dissection {
  std::vector<FrontNodes> fronts;  ///< the last one's border is all that is kept
  std::vector<int> place;          ///< (nodes) in the order of elimination, kept ones behind; -1: held altogether
};

/// @param kept  nodes, ascending; others that are held on all axes are left out
Dissection dissect(const Stiffness& k, std::span<const int> kept);

}  // namespace trocar::tissue
