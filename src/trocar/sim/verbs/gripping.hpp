// Jaws follow the handle, as far as tissue between them lets them; those that can take hold of it.
#pragma once

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

struct Gripping {
  /// Whatever has a handle: which jaws hold, interactions::update_grip knows.
  static bool does(const interactions::ToolModel&) noexcept { return true; }
  static void work(StepContext& context, std::size_t hand) noexcept;
};

}  // namespace trocar::sim
