// A GLFW window with an OpenGL 3.3 core context and Dear ImGui in it: opens, collects what mouse, keyboard and gamepad
// did since the last picture, and shows it.
//
//   Window window("Trocar", {1100, 700});
//   while (!window.wants_to_close()) {
//     window.begin_picture();  ...draw, ImGui...  window.draw_panels();  window.show();
//   }
#pragma once

#include <string>

#include <trocar/devices/mouse_keyboard.hpp>
#include <trocar/render/image.hpp>

#include "picture_size.hpp"

struct GLFWwindow;

namespace trocar::app {

/// Keys of the window itself; the hands' keys are in devices::Key.
struct WindowKeys {
  bool help = false, menu = false;  ///< F1 or H, Esc: went down an odd number of times since the last picture
  bool picture = false, restart = false, quit = false;  ///< F12, R, Q: went down
};

class Window {
 public:
  Window(const std::string& title, PictureSize size);  ///< @throws core::EnvironmentLacks
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  bool wants_to_close() const;
  void close();

  /// At most so many pictures a second, whatever the display: they cost what the simulation may need.
  void set_picture_rate(double most) { m_least_time = 1 / most; }

  /// Takes in the events; afterwards ImGui's frame is open.
  void begin_picture();
  void draw_panels();  ///< ImGui over what is there
  void show();         ///< the finished picture

  /// What the hands did since the last begin_picture(). Nothing while the pointer is free.
  const devices::HandSample& hands() const { return m_sample; }
  const WindowKeys& keys() const { return m_keys; }
  double picture_time() const { return m_picture_time; }  ///< of the last picture, begin to begin [s]

  /// The pointer belongs to the instrument (hidden, endless), or to menus.
  void capture_pointer(bool on);

  int width() const { return m_width; }    ///< [px]
  int height() const { return m_height; }  ///< [px]
  float scale() const { return m_scale; }  ///< of texts and panels; 1 on an ordinary display

  /// The picture that is being made, between draw_panels() and show().
  render::Image read_back() const;

 private:
  static void on_key(GLFWwindow* window, int key, int scancode, int action, int mods);
  static void on_cursor(GLFWwindow* window, double x, double y);
  static void on_scroll(GLFWwindow* window, double x, double y);
  static void on_scale(GLFWwindow* window, float x, float y);
  void set_up_imgui();
  void collect_sample();
  void read_gamepad();
  void wait_for_turn();

  GLFWwindow* m_window = nullptr;
  devices::HandSample m_sample, m_next;
  WindowKeys m_keys, m_next_keys;
  double m_cursor_x = 0, m_cursor_y = 0, m_last_time = 0, m_picture_time = 0, m_least_time = 1.0 / 62;
  bool m_captured = false, m_cursor_known = false, m_scale_changed = false;
  int m_width = 0, m_height = 0;
  float m_scale = 1;
};

}  // namespace trocar::app
