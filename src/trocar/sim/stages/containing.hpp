// The body cavity's ends: walls that are drawn close it only where a scene file has them. What has been torn off could
// leave between them, and what has been cut off would fall for ever; both come to lie in the planes of a box around
// everything that a scene has.
#pragma once

#include <trocar/sim/model/model.hpp>
#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Around all bodies in their drawn shape, all walls and ports, and 3 cm more (our choice).
tissue::Box cavity_around(const Model& model);

/// Stage: turns back bodies that have left Model::cavity. Only speeds change: outward ones end, and inwards nothing
/// gets more than would take it back within a quarter of a second. A body goes out by about its own thickness.
void clamp_to_cavity(StepContext& c) noexcept;

}  // namespace trocar::sim
