// The trainer's window: endoscope picture, panel, help and menu; the simulation runs on a thread of its own at 1 kHz
// and is never waited for nor skipped. Slow machines show slow motion, and say so.
#pragma once

#include "lesson.hpp"
#include "picture_size.hpp"

namespace trocar::app {

struct WindowOptions {
  std::string record;  ///< file; empty: a name of our own in the user's data folder
  std::string trainee;
  std::string input = "mouse";  ///< or a source: see make_source()
  std::string log;              ///< JSON lines of events; empty: $TROCAR_WINDOW_LOG, or none
  PictureSize size;
  double seconds = 0;  ///< 0: no limit
};

/// Opens the window and returns the last attempt's result when it is closed.

/// @throws core::EnvironmentLacks without a display or OpenGL 3.3
Json run_window(const Lesson& lesson, const WindowOptions& options);

}  // namespace trocar::app
