// Stage: the forces with which tissue acts back on the instruments, as a hand or a device with force feedback would
// feel them.
#pragma once

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Adds up what the tissue did to each instrument in this tick; what is pulled too hard slips out of the jaws.
void collect_reaction_forces(StepContext& context) noexcept;

}  // namespace trocar::sim
