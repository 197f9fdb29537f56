// Scissors cut strands, lattices, folds and flesh, and open the vessels in them.
#pragma once

#include <trocar/sim/model/step_context.hpp>
#include <trocar/sim/verbs/record_buffer.hpp>

namespace trocar::sim {

struct Cutting {
  static bool does(const interactions::ToolModel& tool) noexcept { return tool.can().cut; }
  static void work(StepContext& context, std::size_t hand) noexcept;
  static constexpr bool kInAll = true;
  template <class S>
  static auto buffer(S& state) noexcept {
    return RecordBuffer{state.cuts, state.cut_count};
  }
  static bool sound(const Model& model, const interactions::Cut& cut) noexcept;
};

}  // namespace trocar::sim
