// What heat does to vessels: walls that are hot while they touch fuse. Between bipolar jaws the vessel that crosses
// them is sealed over the jaws' width; a wire seals the stump or the hole that it is at. The wall has the temperature
// of the tissue that the electrode heats: vessels are no bodies of heat of their own.
#pragma once

#include <trocar/interactions/verbs/electrode_contact.hpp>
#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Once in a step of the heat, for a hand whose electrode is at tissue.
void seal_vessels(StepContext& context, size_t hand, const interactions::ElectrodeTouch& touch) noexcept;

/// The share of an opening that heat keeps shut: 0 or 1.
double sealed_share(const State& state, int opening) noexcept;
/// Seals that hold, as clips that the flow knows. @param out  (2 kMaxSeals)
void lay_out_seals(const State& state, std::span<vessels::Occlusion> out) noexcept;

}  // namespace trocar::sim
