// A part of the window.
#pragma once

namespace trocar::app {

struct Area {  ///< [px, from the top left]
  float x = 0, y = 0, width = 0, height = 0;
  bool holds(float px, float py) const { return px >= x && px < x + width && py >= y && py < y + height; }
  friend bool operator==(const Area&, const Area&) = default;
};

}  // namespace trocar::app
