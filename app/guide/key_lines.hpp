// Which keys, buttons or pedals a step takes on the device in use, one short line each. Derived from what the step
// needs; a hint that names a control itself gets no second line about it.
#pragma once

#include <string>
#include <vector>

#include <trocar/core/controls/control_keys.hpp>
#include <trocar/sim/model/state.hpp>
#include <trocar/training/exercise/step_needs.hpp>

namespace trocar::app {

struct KeyQuestion {
  const training::StepNeeds& needs;
  const std::string& hint;  ///< with its {key:...}
  core::KeyDevice device;
  int led;  ///< the hand that is controlled, devices::kScope, or kNobody
  const sim::Model& model;
  const sim::State& state;
};
inline constexpr int kNobody = -2;  ///< a source controls everything

std::vector<std::string> key_lines(const KeyQuestion& question);

/// "2" on a keyboard, else how another hand is reached.
std::string hand_key(int hand, core::KeyDevice device);

}  // namespace trocar::app
