// Organs that answer at once: what of them is kept, their stiffness, and its compliance, from the cache or made now.
// Private to the folder.
#pragma once

#include <vector>

#include <trocar/scene/compile/compile.hpp>

namespace trocar::scene {

/// When all that hangs on organs is there: nodes that something can pull at are kept.
void compile_elastostatic(const Description& d, sim::Model& model, std::vector<core::Fault>& faults,
                          CompileReport* report);

}  // namespace trocar::scene
