// Fluid that lies in a pool before anything has begun: level, from the deepest place upwards, over ridges into the next
// hollow when a hollow is full.
#pragma once

#include <span>

#include <trocar/fluids/pool.hpp>

namespace trocar::fluids {

/// Pours as much as there is room for; it lies still. The caller books what it poured.
/// @param floor  (ny x nx) height of the bed [m]
/// @return what was poured: less than `m` only where the field is full to its rim
Mix fill_level(const PoolModel& model, std::span<const float> floor, const Mix& m, PoolState& state);

}  // namespace trocar::fluids
