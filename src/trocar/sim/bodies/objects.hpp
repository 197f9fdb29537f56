// Operations of objects, whatever their kind (interactions/objects/object_kinds.hpp).
#pragma once

#include <trocar/sim/bodies/touching.hpp>
#include <trocar/sim/model/bodies.hpp>

namespace trocar::sim {

/// Loads start afresh.
void hang_objects(StepContext& context) noexcept;
/// An instrument at them.
void touch_objects(StepContext& context, const HandContact& hand) noexcept;
/// Rigid ones on organs and on the walls of pouches.
void rest_objects(StepContext& context) noexcept;
/// Free bodies among walls, instruments and each other. Adds to the step's report.
void advance_objects(StepContext& context) noexcept;

}  // namespace trocar::sim
