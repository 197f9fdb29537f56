// Coagulated tissue is shorter and stiffer: denaturation shrinks it by a tenth and drying by another, its modulus is
// four and ten times what it was (tissue/heat/heat_look.hpp). Strands change their own rest length and stiffness.
// Springs of lattices and folds keep theirs, which are the Model's and which their time step bears; a second one works
// beside each (tissue/network/network_scars.hpp). Bodies that can be cut scar cell by cell, as cells outlive
// every cut.
#pragma once

#include <trocar/interactions/verbs/electrode_contact.hpp>
#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// What heat has changed, body by body, for their steps.
void apply_scars(StepContext& context) noexcept;

/// Once in a step of the heat, for a hand whose electrode is at the tissue `touch`: what shrinks and stiffens there.
void scar_tissue(StepContext& context, const interactions::ElectrodeTouch& touch) noexcept;

}  // namespace trocar::sim
