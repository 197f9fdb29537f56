// Needles and threads among all bodies.
#pragma once

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// What they lie on and press against; tissue bears what they did to it in the last tick.
void rest_sutures(StepContext& context) noexcept;
/// Stage: needles and threads move, pierce, and go through tissue.
void step_sutures(StepContext& context) noexcept;
/// Blades that have just closed part the threads between them: an event each.
void cut_threads(StepContext& context, std::size_t hand) noexcept;
/// A clip that has closed on nothing else: on thread?
void clip_threads(StepContext& context, std::size_t hand, int clip) noexcept;
/// After forces at instruments are known: a needle turns in jaws, a thread slips through them.
void slip_in_jaws(StepContext& context, std::size_t hand) noexcept;

}  // namespace trocar::sim
