// Marks of a scene: what they lie on, found once.
#pragma once

#include <trocar/scene/compile/compile.hpp>

namespace trocar::scene {

/// After bodies and walls.
void compile_marks(const Description& d, sim::Model& model, std::vector<core::Fault>& faults);

}  // namespace trocar::scene
