// What injection needles have to do with organs: forces at which skins give way, and what takes fluid up.
#pragma once

#include <trocar/scene/description/description.hpp>
#include <trocar/sim/model/model.hpp>

namespace trocar::scene {

/// Does some hand of the scene have a needle to choose?
bool has_needle(const sim::Model& model);

/// Nothing in scenes without a needle. After hands and organs.
void compile_injection(const Description& description, sim::Model& model);

}  // namespace trocar::scene
