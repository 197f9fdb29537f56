// What the window says beside and over the picture while an exercise is done: the panel with the step guide, fresh
// notices. Dear ImGui; reads everything, changes nothing but its own state.
#pragma once

#include <string>
#include <vector>

#include <trocar/attempt/hand_pilot.hpp>
#include <trocar/attempt/live.hpp>
#include <trocar/core/controls/control_keys.hpp>
#include <trocar/training/exercise/outlook.hpp>

#include "trainer/feedback.hpp"
#include "trainer/force_feel.hpp"

namespace trocar::app {

/// Everything the panel shows.
struct PanelContent {
  const attempt::Lesson& lesson;
  const attempt::Snapshot& now;
  const devices::HandState* hands = nullptr;  ///< null: a source leads, named by `input`
  const devices::BothHands* both = nullptr;   ///< null: not both hands are led
  std::string input;
  std::string device;  ///< what the source's device says of itself, or empty
  std::string trainee;
  std::string mode;                         ///< "familiarisation: no score", or empty
  std::vector<training::StepStatus> steps;  ///< names and hints; done and now come from the snapshot
  const Feedback& feedback;
  bool paused = false, gamepad = false;  ///< gamepad: the keys at its foot are a gamepad's
  core::KeyDevice device_in_use = core::KeyDevice::mouse_and_keys;
  std::vector<std::string> key_lines = {};         ///< keys that the current step takes
  std::string refusal = {};                        ///< why the last key did nothing; or empty
  bool* details = nullptr;                         ///< engineering figures are shown; not null
  double pull_limit = 5;                           ///< [N]
  const ForceFeel* feel = nullptr;                 ///< null: no trace of the force
  std::optional<training::Foretold> outlook = {};  ///< of what a hand is about to do; told while familiarising
  std::vector<std::string> team = {};              ///< who else takes part, a line each
};

/// Its width beside a window of `width` [px].
float panel_width(float width, float scale);
void draw_panel(const PanelContent& content, float left, float width, float height);
/// Fresh notices over the lower part of the picture.
void draw_notices(const Feedback& feedback, double now, float picture_width, float picture_height);
/// Why it is paused, though nobody paused it, and what helps, in the picture's middle.
void draw_waiting(const std::string& why, const std::vector<std::string>& help, float picture_width,
                  float picture_height);

}  // namespace trocar::app
