// A fold of a scene becomes a membrane: a grid between the strand and the base, what its borders ride on, its sheet.
#pragma once

#include <vector>

#include <trocar/scene/compile.hpp>
#include <trocar/scene/description.hpp>

namespace trocar::scene {

/// Appends to Model::membranes. Solids and strands must be compiled before.
void compile_membrane(const Membrane& membrane, const Tissue& tissue, Vec3d gravity, sim::Model& model,
                      std::vector<core::Fault>& faults, CompileReport* report);

}  // namespace trocar::scene
