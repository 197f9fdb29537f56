// How a sample is read, the same for one hand and for both: what is no number is rest, what counts as pulled, as
// tilted, as squeezed.
#pragma once

#include <cmath>

#include <trocar/devices/mouse_keyboard.hpp>

namespace trocar::devices {

inline constexpr float kTriggerPressed = 0.5f;   ///< share of a trigger's way that is a press
inline constexpr float kTriggerTouched = 0.02f;  ///< ... and that is a finger on it

inline constexpr Key kNumberKeys[kMaxHands] = {Key::one, Key::two, Key::three, Key::four};  ///< of the hands

/// A broken device may send anything; what is no number is rest.
inline float finite(float value) { return std::isfinite(value) ? value : 0.0f; }

/// Is the button or the key down that closes jaws?
inline bool squeezes(const HandSample& sample) {
  return sample.left_button || sample.held.has(Key::g) || sample.held.has(Key::enter);
}

/// Did it go down since `last`?
inline bool went_down(Button b, const HandSample& now, const HandSample& last) {
  return now.gamepad.has(b) && !last.gamepad.has(b);
}

}  // namespace trocar::devices
