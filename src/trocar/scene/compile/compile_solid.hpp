// Compiling what has a surface: organs (loft -> lattice -> springs -> prestress, and their skins) and walls.
#pragma once

#include <vector>

#include <trocar/scene/compile/compile.hpp>

namespace trocar::scene {

void compile_solid(const Solid& solid, const Tissue& tissue, Vec3d gravity, sim::Model& model,
                   std::vector<core::Fault>& faults, CompileReport* report);
void compile_wall(const Wall& wall, sim::Model& model, CompileReport* report);

}  // namespace trocar::scene
