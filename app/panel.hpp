// What the window says beside and over the picture: panel, help, menu, result. Dear ImGui; reads everything, changes
// nothing but its own state.
#pragma once

#include <string>
#include <vector>

#include "hand_pilot.hpp"
#include "live.hpp"

namespace trocar::app {

/// Everything the panel shows.
struct PanelContent {
  const Lesson& lesson;
  const Snapshot& now;
  const devices::HandState* hands = nullptr;  ///< null: a source leads, named by `input`
  std::string input;
  std::vector<training::StepStatus> steps;  ///< names and hints; done and now come from the snapshot
  std::string message;                      ///< the last event
  bool paused = false;
};

enum class Choice { none, resume, restart, quit };

inline constexpr float kPanelWidth = 250;  ///< times the display's scale [px]

void draw_panel(const PanelContent& content, float left, float width, float height, float scale);
/// All keys; drawn over the picture.
void draw_help(float scale);
/// Pause menu; the keys that it names are the window's. `recording` is said, so that people find it.
Choice draw_menu(const std::string& recording, float scale);
/// After the attempt.
Choice draw_result(const Json& result, float scale);

}  // namespace trocar::app
