// What a body's skin has passed through of an instrument in a tick goes with it (interactions/instrument/needle.hpp).
#pragma once

#include <trocar/sim/bodies/views.hpp>

namespace trocar::sim {

/// A body whose skin's vertices are its nodes.
struct CarriedSkin {
  BodyId body;
  const interactions::Surface& surface;
  std::span<const std::uint8_t> open;   ///< (triangles) 1 = it is not there; may be empty
  std::span<const std::uint8_t> fixed;  ///< (nodes) tissue::Held bits
  double thickness = 0;                 ///< [m]
  const double* gap = nullptr;          ///< how far apart they were at least, `each` numbers from hand to hand
  size_t each = 0;
  std::span<tissue::NodeState> rows;
};
void carry_along(const StepContext& context, const CarriedSkin& skin) noexcept;

}  // namespace trocar::sim
