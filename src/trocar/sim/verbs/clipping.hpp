// Clip appliers set clips.
#pragma once

#include <trocar/sim/model/step_context.hpp>
#include <trocar/sim/verbs/record_buffer.hpp>

namespace trocar::sim {

struct Clipping {
  static bool does(const interactions::ToolModel& tool) noexcept { return tool.can().set_clips; }
  static void work(StepContext& context, std::size_t hand) noexcept;
  static constexpr bool kInAll = true;
  template <class S>
  static auto buffer(S& state) noexcept {
    return RecordBuffer{state.clips, state.clip_count};
  }
  static bool sound(const Model& model, const interactions::Clip& clip) noexcept;
};

}  // namespace trocar::sim
