// What the player says beside and over the pictures: where one is, what the step guide showed then, help, menu, the
// progress of a film.
#pragma once

#include <trocar/attempt/playback/captions.hpp>
#include <trocar/attempt/reel.hpp>

#include "player/player.hpp"
#include "shell/area.hpp"

namespace trocar::app {

struct PlayerPanelContent {
  const attempt::Lesson& lesson;
  const sim::Recording& recording;
  const attempt::Findings& found;
  const sim::State& state;
  std::uint64_t now = 0, last = 0, known_until = 0;
  bool replays = true, exact = false, complete = false;
  bool differs = false;         ///< here doing it again is not what was recorded
  std::uint64_t way_to_go = 0;  ///< ticks until the exact State is there
  std::string message;          ///< the last thing done: a picture saved
};

enum class PlayerChoice { none, resume, now_you, picture, film, display, views, help, quit };

inline constexpr float kPlayerPanelWidth = 270;  ///< times the display's scale [px]

void draw_player_panel(const PlayerPanelContent& content, float left, float width, float height);
void draw_player_help();
PlayerChoice draw_player_menu(const PlayerOptions& options);
/// Under the picture: the step with its hint, what is being performed, and a note.
void draw_caption(const attempt::Caption& caption, const std::string& note, const Area& area);
/// True while it shall go on.
bool draw_film_progress(const std::string& path, double share);
/// Something that takes more than a moment, before there is anything to see. @param share 0..1, < 0: not known
void draw_waiting(const std::string& what, double share);

}  // namespace trocar::app
