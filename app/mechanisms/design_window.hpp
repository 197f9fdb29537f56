// `trocar mechanism FILE design` in a window: dimensions and drives by sliders, the mechanism as it stands, the way of
// a frame, how near links come to each other, the optimiser, and saving.
#pragma once

#include <filesystem>
#include <string>

#include <trocar/kinematics/chains/description.hpp>
#include <trocar/pictures/picture_size.hpp>

namespace trocar::app {

struct DesignWindowOptions {
  std::filesystem::path file;
  kinematics::MechanismDescription description;  ///< as read from it
  std::string frame;                             ///< whose way is shown
  double clearance = 1e-4;                       ///< the optimiser's wish [m]
  std::string log;                               ///< JSON lines of events; empty: $TROCAR_WINDOW_LOG
  pictures::PictureSize size{1280, 800};
};

/// @throws core::EnvironmentLacks without a display
void run_design_window(DesignWindowOptions options);

}  // namespace trocar::app
