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
  bool faster = false, slower = false;
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
    {"play, pause", "Space", "button", "A"},
    {"to any moment", "", "drag on the timeline", "left stick"},
    {"step by a picture (1/25 s)", "Left, Right", "buttons", "cross left, right"},
    {"step by a tick (1 ms)", ", .", "", "the same with LT held"},
    {"step by a second", "Shift Left, Right", "", ""},
    {"start, end", "Home, End", "buttons", ""},
    {"last, next mark", "PgUp, PgDn", "click on it; buttons", "LB, RB"},
    {"slower, faster", "Down, Up", "buttons", "cross down, up"},
    {"show less or more of the time", "+ -", "wheel on the timeline", ""},
    {"show all of it", "0", "right click there", "right stick pressed"},
    {"exchange the first two pictures", "C", "double click: it comes first", "Y"},
    {"small picture on, off", "V", "button", "X"},
    {"one picture, two, small one, four", "F2", "menu: Views", "menu: Views"},
    {"endoscope, front, side, above, surgeon", "1 2 3 4 5", "buttons", "B: the next one"},
    {"a second window, for a second screen", "F3", "menu: Views", "menu: Views"},
    {"turn the outside camera, or the one last dragged", "W A S D", "drag", "right stick"},
    {"shift it", "I J K L", "right drag", "right stick with LT held"},
    {"nearer, farther", "E Q", "wheel", "RT; with LT held"},
    {"save the picture", "F12", "menu", "left stick pressed"},
    {"film of the visible time", "X", "button", "menu"},
    {"help; menu", "F1; Esc", "", "back; start"},
};

}  // namespace trocar::app
