// Compiling what moves by itself: peristalsis and breathing.
#pragma once

#include <trocar/scene/compile/compile.hpp>

namespace trocar::scene {

void compile_motion(const Description& d, sim::Model& model, std::vector<core::Fault>& faults);

}  // namespace trocar::scene
