// Organs of tetrahedra: from a mesh, from voxels, or from a loft that can be cut.
#pragma once

#include <trocar/scene/compile/compile.hpp>

namespace trocar::scene {

/// Is the organ made of tetrahedra?
inline bool of_tets(const Solid& solid) { return solid.tets || solid.cuttable; }

/// Appends it to the Model: to its solids, or to its cuttables.
void compile_tets(const Solid& solid, const Tissue& tissue, Vec3d gravity, sim::Model& model,
                  std::vector<core::Fault>& faults, CompileReport* report);

}  // namespace trocar::scene
