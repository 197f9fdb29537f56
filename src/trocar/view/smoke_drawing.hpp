// Smoke in a frame: the simulation's grid, as the renderer marches through it (render/liquid.hpp).
#pragma once

#include <trocar/fluids/smoke.hpp>
#include <trocar/render/frame.hpp>

namespace trocar::view {

/// Sets frame.smoke; leaves it empty where the air is clear.
void list_smoke(const fluids::SmokeModel& model, const fluids::SmokeState& state, render::Frame& frame);

}  // namespace trocar::view
