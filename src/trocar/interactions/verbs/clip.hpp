// A clip applier closes: what lies between its legs is clipped. A clip is a record on its host that closes the lumen
// (all of it only when the whole cross-section is between the legs) and stiffens the tube there.
#pragma once

#include <span>

#include <trocar/interactions/verbs/grasp.hpp>

namespace trocar::interactions {

struct ClipBook {
  std::span<Clip> clips;  ///< kMaxClips
  std::int32_t& count;
};

/// Arms the applier when its jaws are open, measures the closing time, and sets a clip when they have closed.
/// @return true when a clip left the magazine this tick (clips[count-1]; strand -1 if it closed on nothing)
bool update_clip_applier(const ToolModel& model, const ToolShape& shape, int tool_index, const Bodies& bodies,
                         std::span<tissue::StrandState> strand_states, int tips_visible, std::uint64_t tick,
                         ToolState& tool, ClipBook book) noexcept;

/// What a clip would hold if it were set with the jaws as they are: strand (-1: nothing), s, theta, cover and how it
/// lies there; all else of the clip is left alone. Reads strands only.
/// @return where on the strand
StrandPlace fit_clip(const ToolModel& model, const ToolShape& shape, const Bodies& bodies, Clip& clip) noexcept;

}  // namespace trocar::interactions
