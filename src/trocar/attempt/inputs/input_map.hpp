// Which device leads what: a file of roles (attempt/team/duty.hpp) and devices. A gamepad takes its role as it is; any
// axis and button of any joystick, a 3-D mouse among them, can stand for a gamepad's.
//
//   const InputMap map = read_input_map("two_pads.json");
//   for (const InputMap::Part& part : map.parts)
//     if (const devices::DeviceReading* reading = find(part, readings)) ... pad_of(part, *reading)
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <trocar/devices/device_reading.hpp>
#include <trocar/scene/json/schema.hpp>

namespace trocar::attempt {

struct InputMap {
  enum class PadAxis { left_x, left_y, right_x, right_y, left_trigger, right_trigger, wrist_x, wrist_y };
  struct Axis {
    int from = 0;  ///< number of the device's axis
    PadAxis to = PadAxis::left_x;
    double scale = 1, dead = 0;  ///< dead: share of its way, about its middle, that is rest
  };
  struct ButtonTo {
    int from = 0;
    devices::Button to = devices::Button::a;
  };
  struct Part {
    std::string role, device;
    std::vector<Axis> axes;
    std::vector<ButtonTo> buttons;
  };
  std::string file;
  std::vector<Part> parts;
};

/// @throws core::BadInput with all faults
InputMap read_input_map(const std::filesystem::path& file);
InputMap read_input_map_text(const std::string& text, const std::string& name);

/// The device that a part means: "gamepad 2" (the second whose buttons are known by name), "joystick 2" (of all), or
/// part of its name. Null: it is not there.
const devices::DeviceReading* find(const InputMap::Part& part, std::span<const devices::DeviceReading> readings);

/// What the device does, as a gamepad: with axes or buttons given these and nothing else, else as it is.
devices::Gamepad pad_of(const InputMap::Part& part, const devices::DeviceReading& reading);

/// Its shape, for the published schema.
const scene::Shape& input_map_shape();

}  // namespace trocar::attempt
