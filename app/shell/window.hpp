// A GLFW window with an OpenGL 3.3 core context and Dear ImGui in it: opens, collects what mouse, keyboard and gamepad
// did since the last picture, and shows it.
//
//   Window window("Trocar", {1100, 700});
//   while (!window.wants_to_close()) {
//     window.begin_picture();  ...draw, ImGui...  window.draw_panels();  window.show();
//   }
#pragma once

#include <string>
#include <vector>

#include <trocar/devices/mouse_keyboard.hpp>
#include <trocar/pictures/picture_size.hpp>
#include <trocar/render/frame/image.hpp>

#include "shell/gamepads.hpp"

struct GLFWwindow;

namespace trocar::app {

/// What was asked of the window itself since the last picture, by whatever device; the hands' keys are in devices::Key.
/// Nothing while a text is being typed, except help and picture.
struct WindowKeys {
  bool help = false;     ///< F1, the gamepad's back button
  bool pause = false;    ///< P, the gamepad's start button
  bool back = false;     ///< Esc, in menus the gamepad's B
  bool picture = false;  ///< F12
  bool layout = false;   ///< F2
  bool second = false;   ///< F3
};

struct TypedKey {
  int key = 0;   ///< GLFW's
  int mods = 0;  ///< GLFW's
};

/// By how much texts grow with a window of that size [px]: 1 at 1280x720, 1.5 at 1920x1080; never below 0.8.
/// @param display_scale  the display's own, which is left out
float fit_of(int width, int height, float display_scale);

class Window {
 public:
  /// Fitted to the monitor. @param quad_buffers  wanted; see has_quad_buffers()  @throws core::EnvironmentLacks
  Window(const std::string& title, pictures::PictureSize size, bool quad_buffers = false);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  GLFWwindow* handle() const { return m_window; }  ///< for windows that share its textures
  bool wants_to_close() const;
  void close();
  void stay_open();  ///< who would lose something by closing asks first
  void set_title(const std::string& title);

  /// At most so many pictures a second, whatever the display: they cost what the simulation may need.
  void set_picture_rate(double most) { m_least_time = 1 / most; }
  void set_text_size(double size);
  bool full_screen() const;
  void toggle_full_screen();  ///< as F11 does

  /// Takes in the events; afterwards ImGui's frame is open.
  void begin_picture();
  void draw_panels();        ///< ImGui over what is there
  void draw_panels_again();  ///< the same over another eye's picture
  bool has_quad_buffers() const { return m_quad_buffers; }
  /// The pointer as part of the picture, where the screen shows that twice.
  void draw_pointer(bool on);
  void show();  ///< the finished picture

  /// What the hands did since the last begin_picture(). At rest, but for the gamepad, while the pointer is free.
  const devices::HandSample& hands() const { return m_sample; }
  const Gamepads& gamepads() const { return m_gamepads; }
  Gamepads& gamepads() { return m_gamepads; }
  const WindowKeys& keys() const { return m_keys; }
  /// Every key that went down since the last picture, and went up again perhaps; one that is held repeats.
  const std::vector<TypedKey>& typed() const { return m_typed; }
  /// Files that were dropped onto the window since the last picture.
  const std::vector<std::string>& dropped() const { return m_dropped; }
  double picture_time() const { return m_picture_time; }  ///< of the last picture, begin to begin [s]
  bool focused() const;                                   ///< do keys come here?

  /// The pointer belongs to the instrument (hidden, endless), or to menus. In menus arrows and gamepad go from button
  /// to button; in the instrument's hands they do not.
  void capture_pointer(bool on);

  int width() const { return m_width; }                          ///< [px]
  int height() const { return m_height; }                        ///< [px]
  float scale() const { return m_scale * m_fit * m_text_size; }  ///< of texts and panels; 1 at 1280x720
  pictures::PictureSize size_to_keep() const;                    ///< for the next time, as at scale 1

  /// The picture that is being made, between draw_panels() and show().
  render::Image read_back() const;

 private:
  struct Glfw {  ///< the library, as long as the window
    Glfw();
    ~Glfw();
  };
  static void on_key(GLFWwindow* window, int key, int scancode, int action, int mods);
  static void on_cursor(GLFWwindow* window, double x, double y);
  static void on_scroll(GLFWwindow* window, double x, double y);
  static void on_scale(GLFWwindow* window, float x, float y);
  static void on_drop(GLFWwindow* window, int count, const char** paths);
  static void on_button(GLFWwindow* window, int button, int action, int mods);
  void clear() const;
  void set_up_imgui();
  void collect_sample();
  void collect_keys();
  void steer_menus();
  void wait_for_turn();
  void fit_texts();  ///< to the window's size

  Glfw m_glfw;
  Gamepads m_gamepads;
  GLFWwindow* m_window = nullptr;
  devices::HandSample m_sample, m_next;
  devices::Gamepad m_last_pad;
  WindowKeys m_keys, m_next_keys;
  std::vector<TypedKey> m_typed, m_next_typed;
  std::vector<std::string> m_dropped, m_next_dropped;
  double m_cursor_x = 0, m_cursor_y = 0, m_last_time = 0, m_picture_time = 0, m_least_time = 1.0 / 62;
  bool m_quad_buffers = false;
  bool m_captured = false, m_cursor_known = false, m_scale_changed = false;
  unsigned m_buttons_pressed = 0;                 ///< down at any time since the last picture
  std::vector<int> m_keys_pressed, m_keys_shown;  ///< the same; those that this picture's menus were told
  int m_width = 0, m_height = 0;
  float m_scale = 1, m_fit = 1, m_text_size = 1;
  struct {
    int x = 0, y = 0, width = 1280, height = 720;
  } m_plain;  ///< the window's place before it was full screen
};

}  // namespace trocar::app
