// `trocar replay FILE` in a window: any moment of a recording, exactly, from any side.
#pragma once

#include <string>

#include <trocar/attempt/lesson.hpp>
#include <trocar/pictures/picture_size.hpp>
#include <trocar/pictures/two_eyes.hpp>
#include <trocar/render/backend/backend.hpp>
#include <trocar/sim/recording/recording.hpp>

#include "shell/event_log.hpp"
#include "shell/window.hpp"

namespace trocar::app {

struct PlayerOptions {
  std::string file;      ///< the recording; pictures and films are saved beside it
  std::string exercise;  ///< where its exercise is now
  std::string log;       ///< events as JSON lines; empty: $TROCAR_WINDOW_LOG
  pictures::PictureSize size{1280, 800};
  pictures::TwoEyes eyes;  ///< off: as the settings say
  bool inside = false;     ///< the trainer's window: it is left by going back
  bool now_you = false;    ///< a demonstration, after which the trainee may do the same
  std::string note;        ///< shown above the captions: "This demonstration did not reach the pass mark"; empty: none
};

/// How the player was left.
enum class PlayerEnd { closed, back, now_you };

/// Opens the player and returns when it is closed.
/// @throws core::EnvironmentLacks without a display, core::BadInput for what the recording's scene lacks
void run_player(const sim::Recording& recording, PlayerOptions options);

/// The player within a window that is there already, until the person leaves it. The lesson is the recording's.
PlayerEnd play_inside(Window& window, render::Backend& backend, const attempt::Lesson& lesson,
                      const sim::Recording& recording, PlayerOptions options, EventLog& log);

}  // namespace trocar::app
