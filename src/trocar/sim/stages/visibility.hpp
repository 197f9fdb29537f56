// What the endoscope sees, by ray casts at fixed ticks: two samples a tick in turn, so that a score never depends on
// pixels or on the frame rate.
#pragma once

#include <trocar/sim/model/seen.hpp>
#include <trocar/sim/model/work.hpp>

namespace trocar::sim {

inline constexpr int kLooksPerTick = 2;

/// Looks at the samples whose turn it is and notes in State::seen whether they are in view and unoccluded.
void update_visibility(const Model& model, State& state, const Work& work) noexcept;

/// Is the segment from `eye` to `point` free of organs, walls, strands and instruments? The last `margin` metres before
/// the point do not count (it lies on a surface itself).
bool unoccluded(const Model& model, const State& state, const Work& work, Vec3d eye, Vec3d point, double margin,
                int skip_tool, int skip_strand) noexcept;

}  // namespace trocar::sim
