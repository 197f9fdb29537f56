// What the window says beside and over the picture while an exercise is done: the panel with the step guide, fresh
// notices, the rack of hands and instruments, help, first hint, pause menu, result. Dear ImGui; reads everything,
// changes nothing but its own state.
#pragma once

#include <string>
#include <vector>

#include <trocar/attempt/hand_pilot.hpp>
#include <trocar/attempt/live.hpp>
#include <trocar/training/exercise/outlook.hpp>

#include "trainer/feedback.hpp"

namespace trocar::app {

/// Everything the panel shows.
struct PanelContent {
  const attempt::Lesson& lesson;
  const attempt::Snapshot& now;
  const devices::HandState* hands = nullptr;  ///< null: a source leads, named by `input`
  const devices::BothHands* both = nullptr;   ///< null: not both hands are led
  std::string input, trainee;
  std::string mode;                         ///< "familiarisation: no score", or empty
  std::vector<training::StepStatus> steps;  ///< names and hints; done and now come from the snapshot
  const Feedback& feedback;
  bool paused = false, gamepad = false;            ///< gamepad: the keys at its foot are a gamepad's
  double pull_limit = 5;                           ///< [N]
  std::optional<training::Foretold> outlook = {};  ///< of what a hand is about to do; told while familiarising
};

/// Its width beside a window of `width` [px].
float panel_width(float width, float scale);
void draw_panel(const PanelContent& content, float left, float width, float height);
/// Fresh notices over the lower part of the picture.
void draw_notices(const Feedback& feedback, double now, float picture_width, float picture_height);

enum class Choice { none, resume, restart, finish, settings, display, views, help, report, start_screen, quit };

/// All keys and buttons of the devices that are there. Resume closes it. @param both in/out: those of both hands at
/// once
Choice draw_help(bool gamepad, bool left_handed, bool& both);
/// The three things to know. @param again in/out: show it before the next attempt, too
Choice draw_hint(bool gamepad, bool both, bool& again);
/// Pause menu. `why` is said where it was not asked for; `recording` is said, so that people find it.
/// @param display  how things are shown may be chosen: not while it counts
Choice draw_pause(const std::string& why, const std::string& recording, bool scored, bool display);
/// After the attempt. `report`: there is a page to open; `say`: how far it is, or empty
Choice draw_result(const Json& result, const std::string& mode, bool report, const std::string& say);

/// The rack: which hand, which instrument in it; and the generator's panel where there is one.
struct RackChoice {
  bool close = false, pause = false, insert = false, ratchet = false, fine = false;
  bool both = false, exchange = false;  ///< the other of: one hand, both; of both: what the mouse leads
  int hand = -2;                        ///< lead this one (devices::kScope: the endoscope); -2: no choice
  int instrument = -1;                  ///< for the led hand
  std::uint32_t panel_keys = 0;         ///< tissue::PanelKey bits pressed
};
RackChoice draw_rack(const sim::Model& model, const sim::State& state, const devices::BothHands& both,
                     float picture_width);

}  // namespace trocar::app
