#include "start/settings_panel.hpp"

#include <algorithm>

#include <trocar/core/text.hpp>

#include "shell/ui.hpp"

namespace trocar::app {
namespace {

void draw_custom_directions(Settings& s) {
  ui::text(tr("Inverted directions"), ui::kGrey);
  ui::checkbox(tr("instrument sideways"), s.invert_x);
  ImGui::SameLine(0, 20 * ui::scale());
  ui::checkbox(tr("instrument up and down"), s.invert_y);
  ui::checkbox(tr("endoscope sideways"), s.invert_view_x);
  ImGui::SameLine(0, 20 * ui::scale());
  ui::checkbox(tr("endoscope up and down"), s.invert_view_y);
}

/// As in the theatre, or as on a screen; anything else behind a third button.
void draw_directions(Settings& s) {
  static bool custom = false;
  ui::text(tr("Directions"), ui::kBlue);
  const Directions now = directions_of(s);
  custom = custom || now == Directions::custom;
  const auto choice = [&](const char* title, Directions directions, float width, const char* tip) {
    const bool chosen = custom ? directions == Directions::custom : directions == now;
    if (!ui::button(title, {.width = width, .primary = chosen, .tip = tip})) return;
    custom = directions == Directions::custom;
    set_directions(s, directions);
  };
  choice(tr("As on the screen"), Directions::screen, 180, tr("The tip follows the hand."));
  ui::beside(250);
  choice(tr("As in the theatre (fulcrum)"), Directions::theatre, 250,
         tr("The tip moves against the hand, as an instrument does that pivots in the abdominal wall."));
  ui::beside(110);
  choice(tr("Custom"), Directions::custom, 110, tr("Each direction by itself"));
  if (custom) draw_custom_directions(s);
}

void draw_person_settings(Settings& s) {
  ui::text(s.trainee.empty() ? tr("Without a name: these settings last until somebody else practises.")
                             : tr("Settings of {}", s.trainee),
           ui::kGrey);
  ui::text(tr("Hands"), ui::kBlue);
  ui::checkbox(tr("Left-handed: swap mouse buttons, gamepad sides and the order of the hands"), s.left_handed);
  ui::checkbox(tr("Control both hands at once where a scene has two (H, or both shoulder buttons and Y)"),
               s.both_hands);
  ui::checkbox(tr("Show the three things to know before an exercise"), s.show_hint);
  draw_directions(s);
  ui::text(tr("Sensitivity"), ui::kBlue);
  ui::slider(tr("mouse"), s.mouse, kLeastSense, kMostSense, "x %.2f", true);
  ui::slider(tr("mouse wheel"), s.wheel, kLeastSense, kMostSense, "x %.2f", true);
  ui::slider(tr("keyboard"), s.keyboard, kLeastSense, kMostSense, "x %.2f", true);
  ui::slider(tr("gamepad"), s.gamepad, kLeastSense, kMostSense, "x %.2f", true);
  ui::checkbox(tr("Mirrored picture: left and right swapped, hands unchanged"), s.mirrored_picture);
}

/// Two eyes: how, and how deep.
void draw_stereo_settings(Settings& s, bool quad_buffers) {
  ui::text(tr("Two eyes (3D screens and glasses)"), ui::kBlue);
  int k = 0;
  for (const pictures::StereoName& n : pictures::kStereoNames) {
    if (k++ % 3 != 0) ui::beside(190);
    if (ui::button(n.name, {.width = 190, .primary = s.stereo == n.name, .tip = n.meaning})) s.stereo = n.name;
  }
  if (s.stereo == "off") return;
  if (s.stereo == "quad-buffer" && !quad_buffers)
    ui::text(
        tr("This window has no quad buffers: one eye is shown. Restart Trocar. If that does not help, the graphics "
           "driver has no quad buffers for this screen."));
  ui::slider(tr("between the eyes [mm]"), s.eye_distance, pictures::kLeastBase, pictures::kMostBase, "%.1f", false);
  ui::slider(tr("depth of the screen [mm]"), s.convergence, pictures::kLeastConvergence, pictures::kMostConvergence,
             "%.0f", true);
  ui::checkbox(tr("Swap left and right eye (if near things look far)"), s.swap_eyes);
}

void draw_machine_settings(Settings& s, bool sound, bool quad_buffers) {
  ui::heading(tr("Settings of this machine"));
  ui::text(tr("Text and sound"), ui::kBlue);
  ui::slider(tr("text size"), s.text_size, kLeastText, kMostText, "x %.2f", false);
  ui::slider(sound ? tr("sound volume") : tr("sound volume (no device found)"), s.volume, 0, 1, "%.2f", false);
  ui::text(tr("Force on the controlled hand, without a haptic device"), ui::kBlue);
  ui::checkbox(tr("drawn"), s.force_trace);
  ImGui::SameLine(0, 20 * ui::scale());
  ui::checkbox(tr("heard"), s.force_sound);
  ImGui::SameLine(0, 20 * ui::scale());
  ui::checkbox(tr("felt in the gamepad"), s.rumble);
  draw_stereo_settings(s, quad_buffers);
}

}  // namespace

bool draw_settings(Settings& s, const Settings& before, bool sound, bool quad_buffers) {
  bool closed = false;
  ui::begin_middle("settings", 660);
  ui::title(tr("Settings"));
  const float room = 0.97f * ImGui::GetIO().DisplaySize.y - 120 * ui::scale();
  ImGui::BeginChild("list", {0, std::min(room, 500 * ui::scale())}, false, ImGuiWindowFlags_NavFlattened);
  draw_person_settings(s);
  draw_machine_settings(s, sound, quad_buffers);
  ImGui::EndChild();
  if (ui::button(tr("Close"), {.width = 130, .primary = true})) closed = true;
  ImGui::SetItemDefaultFocus();
  ImGui::SameLine();
  if (ui::button(tr("Undo changes"), {.width = 140, .enabled = !(s == before)})) s = before;
  ImGui::SameLine();
  if (ui::button(tr("Defaults"), {.width = 130})) reset_settings(s);
  ImGui::End();
  return closed;
}

}  // namespace trocar::app
