// Pose of the endoscope, and the visibility of targets as the State stores it (stages/visibility.hpp computes it).
#pragma once

#include <trocar/sim/model/state.hpp>

namespace trocar::sim {

/// The scope's frame in this State.
kinematics::ScopeFrame scope_of(const Model& model, const State& state) noexcept;

/// Share of the target's samples that were seen when last looked at.
double visible_share(const Model& model, const State& state, int target) noexcept;
inline bool visible(const Model& model, const State& state, int target) noexcept {
  return target >= 0 && visible_share(model, state, target) >= 0.5;
}

/// How many of the two jaw tips of that hand's instrument are in view.
int jaw_tips_visible(const Model& model, const State& state, int hand) noexcept;

}  // namespace trocar::sim
