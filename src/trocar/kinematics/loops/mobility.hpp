// How many freedoms a mechanism has: coordinates less the rank of its closures' conditions, looked at in several closed
// poses, as a single one may be singular. A formula that counts joints is wrong where conditions depend on each other.
#pragma once

#include <string>
#include <vector>

#include <trocar/kinematics/loops/close.hpp>

namespace trocar::kinematics {

struct Mobility {
  int coordinates = 0, conditions = 0, rank = 0;
  int mobility = 0;         ///< coordinates - rank, the least of all poses
  int counted = 0;          ///< coordinates - conditions: what formulas say that count
  int poses = 0;            ///< closed ones that were looked at
  int singular_poses = 0;   ///< of them with less rank than others
  double smallest = 0;      ///< the smallest singular value that counts, of all poses of full rank (scaled)
  double largest_none = 0;  ///< the largest that counts as none
  bool over_constrained() const noexcept { return rank < conditions; }
};

/// From a pose near a closed one, along random freedoms to other closed ones.
/// @param u  a guess; the first closed pose afterwards
Mobility mobility(const Mechanism& m, std::span<double> u, int poses = 8, unsigned seed = 1);
std::string words(const Mobility& mobility);

}  // namespace trocar::kinematics
