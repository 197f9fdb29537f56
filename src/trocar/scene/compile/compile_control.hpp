// Organs whose masses are the control points of their NURBS surface (tissue/tets/control_cage.hpp).
#pragma once

#include <trocar/scene/compile/compile.hpp>

namespace trocar::scene {

/// Appends it to the Model's solids.
void compile_control(const Solid& solid, const Tissue& tissue, Vec3d gravity, sim::Model& model,
                     std::vector<core::Fault>& faults, CompileReport* report);

}  // namespace trocar::scene
