// `trocar replay FILE` in a window: any moment of a recording, exactly, from any side.
#pragma once

#include <string>

#include <trocar/pictures/picture_size.hpp>
#include <trocar/pictures/two_eyes.hpp>
#include <trocar/sim/recording/recording.hpp>

namespace trocar::app {

struct PlayerOptions {
  std::string file;      ///< the recording; pictures and films are saved beside it
  std::string exercise;  ///< where its exercise is now
  std::string log;       ///< events as JSON lines; empty: $TROCAR_WINDOW_LOG
  pictures::PictureSize size{1280, 800};
  pictures::TwoEyes eyes;  ///< off: as the settings say
};

/// Opens the player and returns when it is closed.
/// @throws core::EnvironmentLacks without a display, core::BadInput for what the recording's scene lacks
void run_player(const sim::Recording& recording, PlayerOptions options);

}  // namespace trocar::app
