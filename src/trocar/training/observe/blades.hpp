// What a hand's scissors would go through if they closed as they are, or as they could be moved: every body of the
// scene is asked what the verb itself asks (interactions/verbs/between_blades.hpp).
#pragma once

#include <trocar/sim/model/state.hpp>

namespace trocar::training {

/// Does a lattice lie between the blades? @param shape  of this tool
/// @param beyond  how far before their tips, too [m]
bool organ_between_blades(const sim::Model& model, const sim::State& state, const interactions::ToolModel& tool,
                          const interactions::ToolShape& shape, double beyond = 0);

/// Share of a strand's cross-section that they would cut; 0: it does not lie between them.
double strand_between_blades(const sim::Model& model, const sim::State& state, const interactions::ToolModel& tool,
                             const interactions::ToolShape& shape, int strand);

}  // namespace trocar::training
