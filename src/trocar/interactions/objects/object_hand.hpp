// An instrument as objects meet it in a tick.
#pragma once

#include <trocar/interactions/bodies/loads.hpp>
#include <trocar/interactions/instrument/touch.hpp>

namespace trocar::interactions {

/// A spring and a dashpot.
struct HoldLaw {
  double stiffness = 0;  ///< [N/m]
  double damping = 0;    ///< [N s/m]
};

struct ObjectHand {
  const ToolModel& tool;
  const ToolState& state;
  Touching& touching;
};

}  // namespace trocar::interactions
