// Smoke in a frame: the simulation's grid, as the renderer marches through it (render/frame/liquid.hpp).
#pragma once

#include <trocar/fluids/smoke.hpp>
#include <trocar/render/frame/frame.hpp>
#include <trocar/sim/model/state.hpp>

namespace trocar::view {

/// Sets frame.smoke; leaves it empty where the air is clear.
void list_smoke(const fluids::SmokeModel& model, const fluids::SmokeState& state, render::Frame& frame);

/// Adds puffs that rise from where current boils tissue: the grid's cells are wider than a plume is (drawn only).
void list_plumes(const sim::Model& model, const sim::State& state, render::Frame& frame);

}  // namespace trocar::view
