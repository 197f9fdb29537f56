// A copy of a part of the window's picture, drawn again below the panels while what it shows stays the same.
#pragma once

#include "area.hpp"

namespace trocar::app {

class Backdrop {
 public:
  Backdrop() = default;
  ~Backdrop();
  Backdrop(const Backdrop&) = delete;
  Backdrop& operator=(const Backdrop&) = delete;

  void copy(int x, int y, int width, int height);  ///< of what is drawn now, from the lower left [px]
  void draw(const Area& area) const;

 private:
  unsigned m_texture = 0;
};

}  // namespace trocar::app
