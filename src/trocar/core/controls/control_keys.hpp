// What the controls are called on each device: "K" on a keyboard, "both shoulders and B" on a gamepad. Hints of
// exercises name a control as {key:declare}, and anyone who shows the hint puts the label of the device in use there.
//
//   with_keys("Say it: {key:declare}", KeyDevice::keyboard)   -> "Say it: K"
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace trocar::core {

enum class KeyDevice { mouse_and_keys, gamepad, gamepad_both, box };  ///< gamepad_both: it moves both hands at once

struct ControlKey {
  std::string_view name;       ///< in hints: "declare"
  const char* mouse_and_keys;  ///< "K"
  const char* gamepad;         ///< "both shoulders and B"
  const char* gamepad_both;    ///< null: as `gamepad`
  const char* box;             ///< null: the box lacks it, the keyboard has it
  std::string_view meaning;    ///< what the control does
};

std::span<const ControlKey> control_keys();
/// In the user's language. @param name  must be one of control_keys()
std::string key_label(std::string_view name, KeyDevice device);

/// The text with every {key:NAME} replaced; unknown names stay as they are.
std::string with_keys(const std::string& text, KeyDevice device);
/// Names within {key:...} that no control has.
std::vector<std::string> unknown_keys(const std::string& text);

}  // namespace trocar::core
