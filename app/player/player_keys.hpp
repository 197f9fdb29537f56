// What keys and gamepad ask the player for, one vocabulary for both and for the buttons on the screen.
#pragma once

#include <optional>
#include <vector>

#include <trocar/devices/mouse_keyboard.hpp>

#include "shell/layout.hpp"
#include "shell/window.hpp"

namespace trocar::app {

struct PlayerCommands {
  bool toggle_play = false, to_start = false, to_end = false, next_mark = false, previous_mark = false;
  bool next_step = false, previous_step = false;  ///< marks of steps only
  bool faster = false, slower = false;
  double speed = 0;                                          ///< this one; 0: as it is
  bool captions = false;                                     ///< on, off
  bool leave = false, now_you = false;                       ///< of a player within the trainer
  bool zoom_in = false, zoom_out = false, show_all = false;  ///< of the timeline
  bool swap = false, inset = false, next_preset = false;     ///< of the pictures
  bool next_layout = false, second_window = false, moved_by_pointer = false;
  std::optional<PaneShows> to_front;  ///< this becomes the large one; is it already: swap
  int preset = -1;                    ///< 0 endoscope, 1.. kCameraPresets
  bool picture = false, film = false;
  int ticks = 0;                        ///< single steps, signed
  double scrub = 0;                     ///< share of the visible stretch, signed
  double turn_yaw = 0, turn_pitch = 0;  ///< of the free camera [rad]
  double closer = 0;                    ///< > 0 nearer: the distance shrinks by exp(-closer)
  double pan_right = 0, pan_up = 0;     ///< in picture heights
};

/// The keyboard: what was typed since the last picture, and what is held in ImGui's open frame.
/// @param dt [s] since the last picture
void read_keys(const std::vector<TypedKey>& typed, double dt, PlayerCommands& commands);

/// The gamepad. Remembers what was down, and repeats steps that are held.
class PadReader {
 public:
  void read(const devices::Gamepad& pad, double dt, PlayerCommands& commands);

 private:
  devices::Gamepad m_last;
  double m_held = 0, m_repeats = 0;  ///< of the steps [s]
};

struct PlayerHelpLine {
  const char *action, *keys, *mouse, *pad;
};
inline constexpr PlayerHelpLine kPlayerHelp[] = {
    {"Play, pause", "Space", "button", "A"},
    {"Go to any moment", "", "drag on the timeline", "left stick"},
    {"Previous, next step", "Shift PgUp, PgDn", "buttons", ""},
    {"Previous, next mark", "PgUp, PgDn", "click on it; buttons", "LB, RB"},
    {"One picture back, forward (1/25 s)", "Left, Right", "buttons", "cross left, right"},
    {"One tick back, forward (1 ms)", ", .", "", "the same with LT held"},
    {"One second back, forward", "Shift Left, Right", "", ""},
    {"Start, end", "Home, End", "buttons", ""},
    {"Slower, faster", "Down, Up", "buttons", "cross down, up"},
    {"Captions on, off", "T", "button", ""},
    {"Zoom the timeline", "+ -", "wheel on the timeline", ""},
    {"Show the whole timeline", "0", "right click there", "right stick pressed"},
    {"Swap the first two pictures", "C", "double click", "Y"},
    {"Small picture on, off", "V", "button", "X"},
    {"One picture, two, a small one, four", "F2", "menu: Views", "menu: Views"},
    {"Endoscope, front, side, above, surgeon", "1 2 3 4 5", "buttons", "B: the next one"},
    {"A second window, for a second screen", "F3", "menu: Views", "menu: Views"},
    {"Rotate the outside camera, or the one last dragged", "W A S D", "drag", "right stick"},
    {"Shift it", "I J K L", "right drag", "right stick with LT held"},
    {"Closer, further away", "E Q", "wheel", "RT; with LT held"},
    {"Save the picture", "F12", "menu", "left stick pressed"},
    {"Export this section as video", "X", "button", "menu"},
    {"Help; menu", "F1; Esc", "", "back; start"},
};

}  // namespace trocar::app
