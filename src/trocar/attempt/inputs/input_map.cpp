#include <algorithm>
#include <array>
#include <cmath>

#include <trocar/attempt/inputs/input_map.hpp>
#include <trocar/scene/json/shape.hpp>

namespace trocar::attempt {
namespace {

namespace keys = scene::keys;
using scene::JsonObject;
using scene::Shape;

const std::vector<std::string>& axis_names() {
  static const std::vector<std::string> names{"left_x",       "left_y",        "right_x", "right_y",
                                              "left_trigger", "right_trigger", "wrist_x", "wrist_y"};
  return names;
}

constexpr int kMostAxes = 64, kMostButtons = 256;

const Shape& axis_shape() {
  static const Shape shape{
      "axis",
      "An axis of the device that acts as an axis of a gamepad.",
      {scene::needed(keys::integer("from", 0, kMostAxes - 1, "the device's axis by number")),
       scene::needed(keys::choice("to", axis_names(), "a gamepad's axis, or one of a wrist")),
       keys::number("scale", -10, 10, "gain of its range, default 1"),
       keys::number("dead", 0, 0.9, "dead zone around the middle, as a share of its range, default 0")}};
  return shape;
}

const Shape& button_shape() {
  static const Shape shape{"button",
                           "A button of the device that acts as a button of a gamepad.",
                           {scene::needed(keys::integer("from", 0, kMostButtons - 1, "the device's button by number")),
                            scene::needed(keys::choice("to", devices::button_names(), "a gamepad's button"))}};
  return shape;
}

const Shape& part_shape() {
  static const Shape shape{
      "part",
      "A device and its target.",
      {scene::needed(keys::text("role", "camera, assistant, left, right, or a trocar's name")),
       scene::needed(keys::text("device", "gamepad N, joystick N, or part of a device's name")),
       keys::objects("axes", axis_shape, 0, "axes that act as a gamepad's; default: unchanged"),
       keys::objects("buttons", button_shape, 0, "buttons that act as a gamepad's; default: unchanged")}};
  return shape;
}

InputMap::Part read_part(const JsonObject& o) {
  InputMap::Part part{o.text("role"), o.text("device"), {}, {}};
  for (const JsonObject& a : o.objects("axes")) {
    const auto to = std::find(axis_names().begin(), axis_names().end(), a.text("to"));
    if (to == axis_names().end()) continue;  // told already
    part.axes.push_back(
        {a.integer("from"), InputMap::PadAxis(to - axis_names().begin()), a.number("scale", 1), a.number("dead", 0)});
  }
  const std::vector<std::string> buttons = devices::button_names();
  for (const JsonObject& b : o.objects("buttons")) {
    const auto to = std::find(buttons.begin(), buttons.end(), b.text("to"));
    if (to != buttons.end()) part.buttons.push_back({b.integer("from"), devices::Button(to - buttons.begin())});
  }
  return part;
}

InputMap read(const scene::JsonDocument& document, std::vector<core::Fault>& faults) {
  InputMap map;
  map.file = document.file;
  const JsonObject o(document.root, input_map_shape(), document.file, faults);
  for (const JsonObject& part : o.objects("parts")) map.parts.push_back(read_part(part));
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  return map;
}

float& axis_of(devices::Gamepad& pad, InputMap::PadAxis axis) {
  const std::array<float*, 8> all{&pad.left_x,       &pad.left_y,        &pad.right_x, &pad.right_y,
                                  &pad.left_trigger, &pad.right_trigger, &pad.wrist_x, &pad.wrist_y};
  return *all[std::size_t(axis)];
}

/// The rest about the middle taken off, the ends kept.
double without_rest(double way, double dead) {
  const double beyond = std::fabs(way) - dead;
  return beyond <= 0 ? 0 : std::copysign(beyond / (1 - dead), way);
}

/// The number in "gamepad 2", or 0.
std::size_t numbered(const std::string& text, const std::string& kind) {
  if (text.compare(0, kind.size() + 1, kind + ' ') != 0) return 0;
  const std::string digits = text.substr(kind.size() + 1);
  if (digits.empty() || digits.size() > 2 || digits.find_first_not_of("0123456789") != std::string::npos) return 0;
  return std::size_t(std::stoi(digits));
}

}  // namespace

const Shape& input_map_shape() {
  static const Shape shape{"input map",
                           "Devices and their targets. Hands without a device here follow mouse, keys and the other "
                           "gamepads.",
                           {keys::text("$schema", "format of this file"), scene::needed(keys::format(1)),
                            scene::needed(keys::objects("parts", part_shape, 1, "devices and their targets"))}};
  return shape;
}

InputMap read_input_map(const std::filesystem::path& file) {
  std::vector<core::Fault> faults;
  return read(scene::load_json(file, faults), faults);
}

InputMap read_input_map_text(const std::string& text, const std::string& name) {
  std::vector<core::Fault> faults;
  return read(scene::parse_json(text, name, faults), faults);
}

const devices::DeviceReading* find(const InputMap::Part& part, std::span<const devices::DeviceReading> readings) {
  const std::size_t pad = numbered(part.device, "gamepad"), any = numbered(part.device, "joystick");
  std::size_t pads = 0, all = 0;
  for (const devices::DeviceReading& r : readings) {
    pads += r.is_pad, ++all;
    if (pad > 0 ? r.is_pad && pads == pad : any > 0 ? all == any : r.name.find(part.device) != std::string::npos)
      return &r;
  }
  return nullptr;
}

devices::Gamepad pad_of(const InputMap::Part& part, const devices::DeviceReading& reading) {
  if (part.axes.empty() && part.buttons.empty()) return reading.pad;
  devices::Gamepad pad;
  for (const InputMap::Axis& a : part.axes) {
    if (std::size_t(a.from) >= reading.axes.size()) continue;
    const double raw = double(reading.axes[std::size_t(a.from)]);
    const double way = a.scale * without_rest(std::isfinite(raw) ? std::clamp(raw, -1.0, 1.0) : 0, a.dead);
    const bool trigger = a.to == InputMap::PadAxis::left_trigger || a.to == InputMap::PadAxis::right_trigger;
    axis_of(pad, a.to) = float(std::clamp(way, trigger ? 0.0 : -1.0, 1.0));
  }
  for (const InputMap::ButtonTo& b : part.buttons)
    if (std::size_t(b.from) < reading.buttons.size() && reading.buttons[std::size_t(b.from)]) pad.set(b.to);
  return pad;
}

}  // namespace trocar::attempt
