// A copy of a part of the window's picture, drawn again below the panels while what it shows stays the same.
#pragma once

namespace trocar::app {

/// A part of the window [px, from the top left].
struct Area {
  float x = 0, y = 0, width = 0, height = 0;
  bool holds(float px, float py) const { return px >= x && px < x + width && py >= y && py < y + height; }
};

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
