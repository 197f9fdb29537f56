// Whose hand did it: for events that tissue makes and not jaws.
#pragma once

#include <initializer_list>

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Of the hands that hold one of the bodies, the one that pulls hardest; where none does, the hand that pulls or
/// presses hardest; -1: no hand exerts any force.
int culprit(const Model& model, const State& state, std::initializer_list<BodyId> bodies) noexcept;

/// @param hand  -1: it tore by itself. Told in any case; nobody is charged with it then
void emit_torn(StepContext& context, int hand, BodyId body) noexcept;

}  // namespace trocar::sim
