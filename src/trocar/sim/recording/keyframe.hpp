// What drawing needs of a State, for 10 Hz keyframes that another version of the physics can still show.
#pragma once

#include <cstdint>
#include <vector>

#include <trocar/sim/model/state.hpp>

namespace trocar::sim {

std::vector<std::uint8_t> display_bytes(const Model& model, const State& state);

/// Puts a keyframe's content into a State made from the same scene. False, and the State unchanged, where it does not
/// fit: another length, a place that is not finite, an index that names nothing.
bool restore_display(const Model& model, const std::vector<std::uint8_t>& bytes, State& state);

}  // namespace trocar::sim
