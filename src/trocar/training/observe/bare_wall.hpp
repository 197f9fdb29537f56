// Where a wall can be taken between jaws: near a place, on the side that faces the hand, and with as little fat and as
// few strands as may be, which the jaws would hold instead of it.
#pragma once

#include <span>

#include <trocar/sim/model/state.hpp>

namespace trocar::training {

/// How jaws come to a wall.
struct Approach {
  Vec3d place;      ///< near which it shall be [m]
  Vec3d from;       ///< the trocar [m]
  double deep = 0;  ///< how far they continue beyond the node [m]
};

/// The node of a membrane that is best taken, none within 3 mm of those that were missed; -1: there is none within
/// 18 mm of the place.
int wall_to_take(const sim::Model& model, const sim::State& state, int membrane, const Approach& approach,
                 std::span<const int> missed = {});

}  // namespace trocar::training
