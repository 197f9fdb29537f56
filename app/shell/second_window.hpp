// A window for a second screen: one picture alone, as the monitor on the wall shows it. Its context shares textures
// with the main window's; the finished picture is laid into it. Closing it ends nothing.
//
//   SecondWindow wall(main, "Trocar: endoscope");
//   wall.show(canvas, legend);                      // after the picture is drawn, in the main window's context
//   if (wall.wants_to_close()) ...
#pragma once

#include <string>

#include <trocar/pictures/legend_drawing.hpp>

#include "shell/pane_canvas.hpp"
#include "shell/window.hpp"

namespace trocar::app {

class SecondWindow {
 public:
  /// Is there a second monitor, or enough space beside the main window?
  static bool has_room(const Window& main);
  /// All of the second monitor where there is one, else beside the main window. It takes no keys.
  /// @throws core::EnvironmentLacks
  SecondWindow(Window& main, const std::string& title);
  ~SecondWindow();
  SecondWindow(const SecondWindow&) = delete;
  SecondWindow& operator=(const SecondWindow&) = delete;

  bool wants_to_close() const;
  void set_title(const std::string& title);
  int width() const;   ///< [px]
  int height() const;  ///< [px]

  /// As large as fits, its shape kept, with the legend in its corner. The main window's context is current again after.
  void show(const PaneCanvas& picture, const view::Legend& legend);

 private:
  void take_legend(const view::Legend& legend);

  Window& m_main;
  GLFWwindow* m_window = nullptr;
  unsigned m_picture = 0, m_legend = 0;  ///< framebuffers of its own context
  unsigned m_legend_texture = 0;
  pictures::LegendPainter m_painter;
  std::vector<std::uint8_t> m_legend_shown;
  int m_legend_width = 0, m_legend_height = 0;
};

}  // namespace trocar::app
