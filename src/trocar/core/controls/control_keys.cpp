#include <trocar/core/controls/control_keys.hpp>
#include <trocar/core/text.hpp>

namespace trocar::core {
namespace {

constexpr ControlKey kControls[] = {
    {"endoscope", "0", "right shoulder", "both shoulders held", "endoscope handle", "control the endoscope"},
    {"instrument", "1 to 4", "right shoulder", "cross up or down", "handle", "control an instrument"},
    {"move", "mouse", "left stick", "stick of its side", "handle", "move the tip, turn the endoscope"},
    {"depth", "wheel", "right stick", "shoulder and stick of its side", "handle", "move along the shaft"},
    {"roll", "right drag", "right stick sideways", "shoulder and stick sideways", "handle", "roll"},
    {"light_post", "R, F", "triggers", "both shoulders and cross", "light post", "turn the light post"},
    {"grasp", "left button", "right trigger", "trigger of its side", "handle", "close the jaws"},
    {"lock", "Space", "left trigger", "cross of its side", nullptr, "lock or unlock the jaws"},
    {"wrist", "I, M, J, L", "right stick with A held", "stick with A held", nullptr, "bend the wrist"},
    {"fine", "Shift", "left stick pressed", nullptr, nullptr, "fine motion"},
    {"into_view", "V", "X", nullptr, nullptr, "bring the instrument into view"},
    {"exchange", "X", "Y", nullptr, "button on the handle", "exchange the instrument"},
    {"both_hands", "H", "both shoulders and Y", nullptr, nullptr, "both hands at once"},
    {"declare", "K", "both shoulders and B", nullptr, "declare pedal", "declare"},
    {"pedal_coagulate", "B", "A", nullptr, "blue pedal", "foot switch: coagulate"},
    {"pedal_cut", "N", "right stick pressed", nullptr, "yellow pedal", "foot switch: cut"},
    {"suction", "D", "right trigger", "trigger of its side", "suction valve", "suction"},
    {"water", "A", "left trigger", "cross of its side", "water valve", "irrigate"},
    {"plunger_press", "A", "left trigger", "cross of its side", nullptr, "press the plunger"},
    {"plunger_draw", "D", "right trigger", "trigger of its side", nullptr, "draw the plunger"},
    {"needle_out", "Space", "right stick pressed", nullptr, nullptr, "needle into its shaft, out of it"},
    {"wipe_lens", "T", "B", nullptr, "lens pedal", "wipe the lens"},
    {"pause", "P", "Start", nullptr, nullptr, "pause"},
    {"help", "F1", "Back", nullptr, nullptr, "help"},
};

const ControlKey* find_control(std::string_view name) {
  for (const ControlKey& c : kControls)
    if (c.name == name) return &c;
  return nullptr;
}

const char* label_on(const ControlKey& c, KeyDevice device) {
  const char* label = nullptr;
  if (device == KeyDevice::gamepad_both) label = c.gamepad_both ? c.gamepad_both : c.gamepad;
  if (device == KeyDevice::gamepad) label = c.gamepad;
  if (device == KeyDevice::box) label = c.box;
  return label ? label : c.mouse_and_keys;
}

constexpr std::string_view kOpen = "{key:";

/// Calls take(name) for each placeholder; it returns what comes in its place.
template <class Take>
std::string replaced(const std::string& text, Take&& take) {
  std::string out;
  std::size_t at = 0;
  for (std::size_t open; (open = text.find(kOpen, at)) != std::string::npos;) {
    const std::size_t end = text.find('}', open);
    if (end == std::string::npos) break;
    out.append(text, at, open - at);
    out += take(std::string_view(text).substr(open + kOpen.size(), end - open - kOpen.size()));
    at = end + 1;
  }
  return out.append(text, at);
}

}  // namespace

std::span<const ControlKey> control_keys() { return kControls; }

std::string key_label(std::string_view name, KeyDevice device) {
  const ControlKey* c = find_control(name);
  return c ? tr(label_on(*c, device)) : std::string(name);
}

std::string with_keys(const std::string& text, KeyDevice device) {
  return replaced(text, [device](std::string_view name) {
    return find_control(name) ? key_label(name, device) : std::string(kOpen) + std::string(name) + "}";
  });
}

std::vector<std::string> unknown_keys(const std::string& text) {
  std::vector<std::string> out;
  replaced(text, [&out](std::string_view name) {
    if (!find_control(name)) out.emplace_back(name);
    return std::string();
  });
  return out;
}

}  // namespace trocar::core
