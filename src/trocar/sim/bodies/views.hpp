// All bodies at once, in a tick.
#pragma once

#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// [m] folds and organs further from an instrument than this are not looked at
inline constexpr double kNearSheet = 0.03;

inline interactions::Bodies bodies_of(const StepContext& c) noexcept {
  return {c.model, c.state, &c.work, {&c.model.objects, &c.state.objects, &c.work.objects}};
}

}  // namespace trocar::sim
