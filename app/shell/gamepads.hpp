// Gamepads: which are plugged in, what the one in use does. GLFW's own mapping of pads to buttons and sticks; a seam
// for tests and for people with a device of their own feeds samples as text lines instead.
//
// The seam: $TROCAR_GAMEPAD names a file or a pipe that is read as it grows, one line a picture, so that a press and
// its release never fall together:
//
//   0.5 -1 0 0 0 0.8 y left_shoulder     left stick x y, right stick x y, left and right trigger, buttons that are down
//   gone                                 unplugged; the next line of numbers plugs it in again
//
// Several names with commas between them are several pads. What is no such line is left out.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <trocar/devices/device_reading.hpp>

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
  /// These are never the one in use: they have a part of their own. By default none.
  void leave_out(std::function<bool(const devices::DeviceReading&)> claimed) { m_claimed = std::move(claimed); }

  const devices::Gamepad& state() const { return m_state; }          ///< of the one in use, at rest where there is none
  const std::vector<std::string>& names() const { return m_names; }  ///< of those that may be in use
  const std::string& guid() const { return m_guid; }  ///< of the one in use, as GLFW tells it; empty: none, or the seam
  bool lost() const { return m_lost; }                ///< the one in use was unplugged since the last poll()
  bool present() const { return !m_names.empty(); }
  const std::vector<devices::DeviceReading>& all() const { return m_all; }  ///< pads and other joysticks, by number

 private:
  class Seam;
  void poll_seams();
  void poll_glfw();
  void choose_used();

  std::vector<Seam> m_seams;
  std::vector<devices::DeviceReading> m_all;
  std::vector<int> m_numbers;  ///< of m_all: what stays a device's own while others come and go
  std::function<bool(const devices::DeviceReading&)> m_claimed;
  devices::Gamepad m_state;
  std::vector<std::string> m_names;
  std::string m_guid;
  int m_used = -1;  ///< one of m_numbers
  bool m_lost = false;
};

}  // namespace trocar::app
