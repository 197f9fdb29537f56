// The bed of the pool where organs are part of it (`pool_on`): walls as in the scene, organs where they lie now. Four
// rows of it follow in a tick, so that it costs little; all of it every 32 ms where there are 128.
#pragma once

#include <span>

#include <trocar/sim/model/state.hpp>

namespace trocar::sim {

/// Four rows more, before fluids move. @param surfaces  organs first, posed
void follow_floor(const Model& model, std::span<const interactions::Surface> surfaces, State& state) noexcept;

/// All rows at once, for a State that was not stepped.
void lay_floor(const Model& model, State& state);

}  // namespace trocar::sim
