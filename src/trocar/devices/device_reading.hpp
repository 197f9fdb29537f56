// One gamepad or joystick as it is read: what every kind of them has.
#pragma once

#include <string>
#include <vector>

#include <trocar/devices/mouse_keyboard.hpp>

namespace trocar::devices {

struct DeviceReading {
  std::string name;  ///< as its maker calls it
  bool is_pad = false;
  Gamepad pad;                ///< where its buttons and sticks are known by name
  std::vector<float> axes;    ///< -1..1, as they are numbered
  std::vector<bool> buttons;  ///< down
};

}  // namespace trocar::devices
