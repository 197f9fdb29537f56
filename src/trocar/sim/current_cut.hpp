// A continuous wave parts tissue: where the cells at the wire have burst, organs and folds are cut along the way that
// it goes, as by a small blade; a strand is cut through once it has burst across.
#pragma once

#include <trocar/interactions/electrode_contact.hpp>
#include <trocar/sim/step.hpp>

namespace trocar::sim {

/// Once in a step of the heat, for a hand whose electrode gives a continuous wave to the tissue at `touch`.
void part_tissue(StepContext& context, size_t hand, const interactions::ElectrodeTouch& touch) noexcept;

}  // namespace trocar::sim
