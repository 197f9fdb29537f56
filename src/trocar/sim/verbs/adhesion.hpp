// Stage: adhesion of tissue to electrodes. Char sticks to them, is pulled along, and tears off.
#pragma once

#include <trocar/interactions/verbs/electrode_contact.hpp>
#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Among the loads of a tick: char sticks to electrodes.
void apply_adhesion(StepContext& context) noexcept;

/// What has been heated enough sticks to the electrode from now on.
void begin_adhesion(StepContext& context, size_t hand, const interactions::ElectrodeTouch& touch,
                    ElectrodeHand& electrode) noexcept;

/// The electrode of a hand: cold and clean when the hand has changed its instrument.
ElectrodeHand& electrode_of(StepContext& context, size_t hand) noexcept;

}  // namespace trocar::sim
