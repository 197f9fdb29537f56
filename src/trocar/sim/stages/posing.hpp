// Stages: poses of skins, views of nodes and walls.
#pragma once

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Skins: x = W q, boxes.
void pose_skins(StepContext& context) noexcept;

/// Walls, which never move: hands meet them before skins are posed.
void view_walls(StepContext& context) noexcept;

/// Where organs' nodes are: their States change places when they advance.
void view_organs(StepContext& context) noexcept;

}  // namespace trocar::sim
