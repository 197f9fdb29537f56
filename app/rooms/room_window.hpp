// `trocar room FILE` in a window: the room from outside, its table tilted, ports dragged, a programme played.
#pragma once

#include <string>

#include <trocar/pictures/picture_size.hpp>
#include <trocar/scene/operating_room/room.hpp>

namespace trocar::app {

struct RoomWindowOptions {
  scene::Room room;
  scene::Programme programme;  ///< without moves: none
  std::string log;             ///< events as JSON lines; empty: $TROCAR_WINDOW_LOG
  pictures::PictureSize size{1280, 800};
};

/// Opens the window and returns when it is closed. @throws core::EnvironmentLacks without a display
void run_room_window(RoomWindowOptions options);

}  // namespace trocar::app
