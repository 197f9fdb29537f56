// What a recording can say of a replay that went another way: it holds no full States, but what was drawn.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <trocar/sim/model/state.hpp>
#include <trocar/sim/recording/recording.hpp>

namespace trocar::sim {

inline constexpr const char* kDoesNotFit = "it does not fit the scene";

/// The first field that is drawn otherwise than in a keyframe of the same tick, recorded value first, as
/// first_difference() names it. Places count in steps of 0.01 mm. Empty where nothing that is drawn differs;
/// kDoesNotFit where the keyframe is none of this scene.
std::string shown_difference(const Model& model, const std::vector<std::uint8_t>& keyframe, const State& state);

/// The same in words, for a State whose hash is another than the recording's. Empty where the recording has no keyframe
/// of that tick.
std::string told_difference(const Model& model, const Recording& recording, const State& state);

}  // namespace trocar::sim
