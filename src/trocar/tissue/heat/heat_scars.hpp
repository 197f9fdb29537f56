// What heat has left in tissue, in few bytes: enough to draw it (heat_look.hpp), not to continue with it. Six shades of
// coagulation, three of water, eight of the highest temperature; runs of equal cells once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/tissue/heat/heat.hpp>

namespace trocar::tissue {

/// Appends the scars of all bricks that have some.
void put_scars(const HeatState& state, std::vector<std::uint8_t>& out);

/// @param state  becomes cold tissue with those scars; undefined where this fails
/// @return bytes read; -1 where they are no scars, or more than the model has bricks for
std::ptrdiff_t take_scars(const HeatModel& model, std::span<const std::uint8_t> bytes, HeatState& state);

}  // namespace trocar::tissue
