// Retrieval bags in a step: what the cloth lies on, what is in it, and the hand that has it
// (interactions/objects/bag.hpp).
#pragma once

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Cloth on organs and walls.
void rest_bags(StepContext& context) noexcept;
/// Stage: the hoop goes with its hand, the cloth hangs from it, and holds what is in it.
void update_bags(StepContext& context) noexcept;

}  // namespace trocar::sim
