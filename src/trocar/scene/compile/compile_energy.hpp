// Current and heat of a scene: the generator's panel, the grid, and which cells of which body are tissue.
#pragma once

#include <vector>

#include <trocar/scene/description/description.hpp>
#include <trocar/sim/model/model.hpp>

namespace trocar::scene {

/// Fills Model::energy. All bodies must be compiled before.
void compile_energy(const Description& description, sim::Model& model, std::vector<core::Fault>& faults);

}  // namespace trocar::scene
