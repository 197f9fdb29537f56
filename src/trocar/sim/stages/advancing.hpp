// Stages: bodies, and couplings to each other and to space.
#pragma once

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Clears the loads of the last tick and adds those of the springs that hold organs in space.
void apply_anchor_loads(StepContext& context) noexcept;
/// Folds pull on the bodies that carry them.
void apply_border_loads(StepContext& context) noexcept;
/// Strands: implicit, ends where their hosts put them, pulling on them.
void advance_strands(StepContext& context) noexcept;
/// Organs: explicit networks in their own sub-steps.
void advance_organs(StepContext& context) noexcept;
/// Folds: borders go where their holders have gone.
void advance_membranes(StepContext& context) noexcept;

}  // namespace trocar::sim
