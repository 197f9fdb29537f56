// The cloth of a bag: a cylinder under the hoop with a round bottom, in rows of nodes.
#pragma once

#include <trocar/interactions/objects/bag.hpp>

namespace trocar::interactions {

struct BagDescription {
  double hoop = 0.030, deep = 0.110;  ///< radius of the mouth; to the bottom, at least one and a half radii [m]
  double weight = 0.004;              ///< of the cloth with what clings to it [kg]
  double spacing = 0.0118;            ///< of nodes, about [m]
};

/// Without what may be in it.
BagModel build(const BagDescription& description);

}  // namespace trocar::interactions
