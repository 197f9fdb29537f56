// `trocar box calibrate` in a window: looks for the box at a port, asks one question after the other (see
// attempt/box/assistant.hpp), shows all channels as they move, and writes the box's file.
#pragma once

#include <filesystem>
#include <string>

#include <trocar/devices/box/wiring.hpp>

namespace trocar::app {

struct CalibrationOptions {
  std::string port;
  devices::BoxWiring basis;      ///< line and filter; tried first
  bool settled = false;          ///< the line was given: no others are tried
  std::filesystem::path output;  ///< where the file goes
  std::string log;               ///< events as JSON lines; empty: $TROCAR_WINDOW_LOG
};

/// Opens the window and returns when it is closed. @returns whether the file was written
/// @throws core::EnvironmentLacks without a display
bool calibrate_in_window(const CalibrationOptions& options);

}  // namespace trocar::app
