// A picture of its own size that stays until it is drawn again, and can be laid into windows.
#pragma once

#include <trocar/render/frame/frame.hpp>

namespace trocar::app {

class PaneCanvas {
 public:
  PaneCanvas() = default;
  ~PaneCanvas();
  PaneCanvas(PaneCanvas&& other) noexcept;
  PaneCanvas& operator=(PaneCanvas&&) = delete;

  /// Where the next picture goes. What was there is gone where the size is another one.
  render::Target target(int width, int height);
  /// Takes what the window shows at `from` (its own framebuffer's coordinates).
  void copy(const render::Target& from);
  /// Over a part of the window of that size. @param mirrored  left and right exchanged
  void lay(const render::Target& to, bool mirrored = false) const;

  unsigned texture() const { return m_texture; }
  int width() const { return m_width; }
  int height() const { return m_height; }

 private:
  unsigned m_texture = 0, m_framebuffer = 0;
  int m_width = 0, m_height = 0;
};

}  // namespace trocar::app
