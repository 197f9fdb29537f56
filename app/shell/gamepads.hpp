// Gamepads: which are plugged in, what the one in use does. GLFW's own mapping of pads to buttons and sticks; a seam
// for tests and for people with a device of their own feeds samples as text lines instead.
//
// The seam: $TROCAR_GAMEPAD names a file or a pipe that is read as it grows, one line a picture, so that a press and
// its release never fall together:
//
//   0.5 -1 0 0 0 0.8 y left_shoulder     left stick x y, right stick x y, left and right trigger, buttons that are down
//   gone                                 unplugged; the next line of numbers plugs it in again
//
// What is no such line is left out.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <trocar/devices/mouse_keyboard.hpp>

namespace trocar::app {

/// One line of the seam: a sample, or nothing (`gone` set where the line says so).
std::optional<devices::Gamepad> read_gamepad_line(const std::string& line, bool& gone);

/// Is a finger on it?
bool touched(const devices::Gamepad& pad);

class Gamepads {
 public:
  Gamepads();  ///< after glfwInit()
  ~Gamepads();

  /// Once per picture. The pad in use is the one last touched; it stays the one in use until another is touched.
  void poll();

  const devices::Gamepad& state() const { return m_state; }          ///< of the one in use, at rest where there is none
  const std::vector<std::string>& names() const { return m_names; }  ///< of all that are plugged in
  const std::string& guid() const { return m_guid; }  ///< of the one in use, as GLFW tells it; empty: none, or the seam
  bool lost() const { return m_lost; }                ///< the one in use was unplugged since the last poll()
  bool present() const { return !m_names.empty(); }

 private:
  class Seam;
  void poll_seam();
  void poll_glfw();

  std::unique_ptr<Seam> m_seam;
  devices::Gamepad m_state;
  std::vector<std::string> m_names;
  std::string m_guid;
  int m_used = -1;  ///< GLFW's number
  bool m_lost = false;
};

}  // namespace trocar::app
