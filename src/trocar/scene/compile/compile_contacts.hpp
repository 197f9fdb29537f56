// Which bodies can meet: pairs of samples and surfaces, and where each sample starts.
#pragma once

#include <trocar/sim/model/model.hpp>

namespace trocar::scene {

void compile_contacts(sim::Model& model);

}  // namespace trocar::scene
