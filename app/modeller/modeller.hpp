// `trocar model` in a window: organs and scenes shaped by hand, tried at once, and operated on.
#pragma once

#include <string>

#include <trocar/pictures/picture_size.hpp>

namespace trocar::app {

struct ModellerOptions {
  std::string file;  ///< opened at the start; empty: the start screen
  std::string log;   ///< events as JSON lines; empty: $TROCAR_WINDOW_LOG
  pictures::PictureSize size{1360, 850};
};

/// Opens the modeller and returns when it is closed.
/// @throws core::EnvironmentLacks without a display, core::BadInput for a file that cannot be read
void run_modeller(const ModellerOptions& options);

}  // namespace trocar::app
