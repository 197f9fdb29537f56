// The rows that show how near the current step is: a tick or a ring, name, value, target, and a thin bar.
#pragma once

#include <vector>

#include <trocar/training/rules/nearness.hpp>

namespace trocar::app {

/// Within the open ImGui window, as wide as it is.
void draw_nearness(const std::vector<training::Nearness>& rows);
/// As high as draw_nearness() will be in a window of that width [px].
float nearness_height(const std::vector<training::Nearness>& rows, float width);

/// Where a row's bar shows the value and the target, as shares of its width.
struct NearnessBar {
  float value = 0;         ///< where the pointer stands; below 0: nowhere
  float from = 0, to = 1;  ///< the zone in which the value has to lie
  bool filled = false;     ///< from the left up to the value, as what is collected
};
NearnessBar bar_of(const training::Nearness& row);

}  // namespace trocar::app
