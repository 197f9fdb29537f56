// Stage: current passes from electrodes into tissue, heat spreads, vessels seal, tissue parts under a continuous wave.
#pragma once

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Nothing in scenes without energy. Leaves Work::steam and Work::current_flows for the fluids.
void heat_tissue(StepContext& context) noexcept;

/// What the pedals of an Input ask for.
inline tissue::FootSwitch foot_switch(const Input& input) noexcept {
  return {.yellow = (input.pedals & kYellow) != 0, .blue = (input.pedals & kBlue) != 0};
}

/// The keys of the generator's panel that an Input holds down.
inline std::uint32_t panel_keys(const Input& input) noexcept { return input.pedals >> kPanelBit & tissue::kPanelKeys; }

}  // namespace trocar::sim
