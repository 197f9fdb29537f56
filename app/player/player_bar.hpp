// The player's lower edge: buttons, speed, and the timeline with its marks. Dear ImGui; says what was asked for,
// changes nothing but its own state and what is visible of the time.
#pragma once

#include <trocar/attempt/reel.hpp>

#include "player/player_keys.hpp"

namespace trocar::app {

struct BarContent {
  const attempt::Findings& found;
  std::uint64_t now = 0;
  std::uint64_t known_until = 0;
  std::uint64_t differs_from = attempt::Reel::kNowhere;
  bool playing = false, endoscope = true, inset = true;
  double speed = 1;
  bool captions = true, inside = false, now_you = false;
};

/// How high the bar is that shows its buttons and a timeline, at that width and scale of texts [px].
float bar_height(float width, float scale);

/// @param seek set to the tick that the pointer asks for; unchanged where it does not
void draw_bar(const BarContent& content, attempt::Timeline& line, float width, float top, float height,
              PlayerCommands& commands, std::uint64_t& seek);

}  // namespace trocar::app
