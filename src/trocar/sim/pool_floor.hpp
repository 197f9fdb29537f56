// The bed of the pool where organs are part of it (`pool_on`): walls as drawn, organs as they lie now. Four rows of it
// follow in a tick, so that it costs little; all of it every 32 ms where there are 128.
#pragma once

#include <trocar/sim/stage.hpp>

namespace trocar::sim {

/// Before fluids move; skins are posed.
void follow_floor(StepContext& context) noexcept;

/// All rows at once, for a State that was not stepped.
void lay_floor(const Model& model, State& state);

}  // namespace trocar::sim
