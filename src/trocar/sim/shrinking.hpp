// Coagulated tissue draws together: denaturation shrinks it by a tenth, drying by another (tissue/heat_look.hpp).
// Strands have a shorter length of rest there. Springs of lattices and folds keep theirs, which is the Model's; each
// that heat has shrunk to a share s of its length is helped by a pull of stiffness k (1/s - 1) between its ends, with
// which it is at rest at s l. That pull is a load, taken implicitly: no body needs a shorter step for it. Bodies that
// can be cut do not shrink.
#pragma once

#include <trocar/interactions/electrode_contact.hpp>
#include <trocar/sim/step.hpp>

namespace trocar::sim {

/// Among the loads of a tick: what has shrunk pulls.
void draw_together(StepContext& context) noexcept;

/// Once in a step of the heat, for a hand whose electrode is at the tissue `touch`: what shrinks there.
void shrink_tissue(StepContext& context, const interactions::ElectrodeTouch& touch) noexcept;

}  // namespace trocar::sim
