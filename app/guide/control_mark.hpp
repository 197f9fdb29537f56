// Shows in the picture what is controlled: a ring with the hand's number at the tip, and, where the tip is out of view,
// an arrow at the picture's edge with the key that brings it into view.
#pragma once

#include <string>

#include <trocar/sim/model/state.hpp>

#include "shell/area.hpp"

namespace trocar::app {

/// Where a hand's tip is in the endoscope's picture, from its middle; the circle of the picture has the radius 1.
struct TipInPicture {
  float right = 0, up = 0;
  bool in_view = false;  ///< within the circle
};
TipInPicture tip_in_circle(const sim::Model& model, const sim::State& state, int hand);

/// Over the picture, below panels. @param area  of the endoscope's picture  @param hand  a hand that is controlled
/// @param key  that brings it into view
void draw_control_mark(const sim::Model& model, const sim::State& state, int hand, const Area& area, bool mirrored,
                       const std::string& key);

}  // namespace trocar::app
