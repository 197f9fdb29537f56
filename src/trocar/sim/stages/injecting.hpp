// Stages of injection needles: points go in and out, fluid in organs pushes, plungers are pressed and drawn.
#pragma once

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Needles' points dent skins, pierce them and carry them along.
void pierce_tissue(StepContext& context) noexcept;

/// What lies in organs pushes their cells.
void swell_tissue(StepContext& context) noexcept;

/// Plungers: what flows out of needles, into tissue, vessels or the open; what leaks back, and what vessels take up.
void inject(StepContext& context) noexcept;

/// How blanched the tissue is that carries a vessel, 0 .. 1.
double blanched_around(const Model& model, const State& state, const interactions::VesselPath& path) noexcept;

/// How blanched a skin is at a vertex.
double blanched_at(const State& state, std::size_t organ, const tissue::Skin& skin, int vertex) noexcept;

}  // namespace trocar::sim
