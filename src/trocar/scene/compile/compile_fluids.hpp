// Where a scene's fluids can be: the pool's field and floor, places of film on its bodies.
#pragma once

#include <vector>

#include <trocar/scene/description/description.hpp>
#include <trocar/sim/model/model.hpp>

namespace trocar::scene {

/// Fills Model::wet. All bodies must be compiled before.
void compile_fluids(const Description& description, sim::Model& model, std::vector<core::Fault>& faults);

}  // namespace trocar::scene
