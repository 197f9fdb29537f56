#include <algorithm>
#include <cmath>

#include <trocar/devices/mouse_keyboard.hpp>

namespace trocar::devices {
namespace {

constexpr std::array<const char*, std::size_t(Key::count)> kKeyNames = {"Tab", "1", "2", "3", "4",     "0",    "C",
                                                                        "Q",   "E", "R", "F", "Space", "Shift"};

constexpr HelpLine kHelp[] = {
    {"1 2 3 4", "lead this instrument; the others keep pose and grip"},
    {"Tab", "lead the next instrument"},
    {"0 C", "lead the endoscope"},
    {"Mouse", "tip sideways, up and down in the picture; with the endoscope: where it looks"},
    {"Wheel", "deeper (away from you) and back"},
    {"Left button", "close the handle as long as it is held; let go: it opens"},
    {"Space", "ratchet on or off: the handle keeps its grip when let go"},
    {"Q E, right drag", "roll the instrument; with the endoscope: roll the picture"},
    {"R F", "turn the light post of an oblique endoscope"},
    {"Shift", "fine: a quarter of the motion"},
    {"Gamepad left stick", "tip sideways, up and down; with the endoscope: where it looks"},
    {"Gamepad right stick", "up and down: deeper and back; sideways: roll"},
    {"Gamepad right trigger", "close the handle as far as it is pulled; with the endoscope: light post"},
    {"Gamepad left trigger", "ratchet on or off; with the endoscope: light post the other way"},
    {"Gamepad shoulders", "lead the previous or the next instrument, the endoscope among them"},
};

constexpr float kLongestSample = 0.1f, kTriggerPressed = 0.5f, kTriggerTouched = 0.02f;

/// A broken device may send anything; what is no number is rest.
float finite(float value) { return std::isfinite(value) ? value : 0.0f; }

/// A stick's way without its rest zone, the middle part made gentle.
float shaped(float way, float dead) {
  way = std::clamp(finite(way), -1.0f, 1.0f);
  const float size = std::abs(way);
  if (size <= dead) return 0;
  const float share = (size - dead) / (1 - dead);
  return std::copysign(share * share, way);
}

float key_axis(const KeySet& held, Key minus, Key plus) { return float(held.has(plus)) - float(held.has(minus)); }

// --- which one is led ---

void choose(int led, HandState& state) {
  if (led == state.led) return;
  state.led = led;
  state.opening = false;
  state.waiting = true;
  if (led != kScope) state.last_instrument = led;
}

void choose_next_instrument(int instruments, HandState& state) {
  choose(state.led == kScope ? state.last_instrument : (state.led + 1) % instruments, state);
}

/// Through all instruments and the scope, which stands behind the last.
void choose_neighbour(int step, int instruments, HandState& state) {
  const int places = instruments + 1, here = state.led == kScope ? instruments : state.led;
  const int there = (here + step + places) % places;
  choose(there == instruments ? kScope : there, state);
}

void choose_led(int instruments, const HandSample& sample, HandState& state) {
  constexpr Key kNumbers[kMaxHands] = {Key::one, Key::two, Key::three, Key::four};
  for (int i = 0; i < instruments; ++i)
    if (sample.pressed.has(kNumbers[i])) choose(i, state);
  if (sample.pressed.has(Key::tab)) choose_next_instrument(instruments, state);
  if (sample.pressed.has(Key::zero) || sample.pressed.has(Key::c)) choose(kScope, state);
  const Gamepad &now = sample.gamepad, &before = state.gamepad;
  if (now.left_shoulder && !before.left_shoulder) choose_neighbour(-1, instruments, state);
  if (now.right_shoulder && !before.right_shoulder) choose_neighbour(+1, instruments, state);
}

// --- what it does ---

/// One sample's rates: pixels, seconds and notches already include Shift.
struct Scaled {
  float dx, dy, wheel, seconds;
  float stick_x, stick_y, stick_in, stick_roll;
};

Scaled scaled(const HandSettings& settings, const HandSample& sample) {
  const float fine = sample.held.has(Key::shift) ? settings.fine : 1.0f;
  const Gamepad& pad = sample.gamepad;
  const auto stick = [&](float way) { return shaped(way, settings.stick_dead); };
  return {fine * finite(sample.dx),    fine * finite(sample.dy),
          fine * finite(sample.wheel), fine * std::clamp(finite(sample.dt), 0.0f, kLongestSample),
          stick(pad.left_x),           stick(pad.left_y),
          -stick(pad.right_y),  // pushed away = deeper
          stick(pad.right_x)};
}

/// Q and E, the right stick; dragging is added where it applies.
float roll_of(const HandSettings& settings, const HandSample& sample, const Scaled& s) {
  return s.seconds *
             (settings.roll_per_second * key_axis(sample.held, Key::q, Key::e) + settings.stick_roll * s.stick_roll) +
         (sample.right_button ? settings.roll_per_pixel * s.dx : 0.0f);
}

float depth_of(const HandSettings& settings, const Scaled& s) {
  return settings.metres_per_notch * s.wheel + settings.stick_speed * s.stick_in * s.seconds;
}

ScopeMotion scope_motion(const HandSettings& settings, const HandSample& sample, const Scaled& s) {
  const float pixels = sample.right_button ? 0.0f : settings.view_per_pixel, stick = settings.stick_view * s.seconds;
  const Gamepad& pad = sample.gamepad;
  const float triggers = std::clamp(finite(pad.right_trigger) - finite(pad.left_trigger), -1.0f, 1.0f);
  ScopeMotion motion;
  motion.right = pixels * s.dx + stick * s.stick_x;
  motion.up = -pixels * s.dy - stick * s.stick_y;
  motion.in = depth_of(settings, s);
  motion.head = roll_of(settings, sample, s);
  motion.post = settings.post_per_second * s.seconds * (key_axis(sample.held, Key::f, Key::r) + triggers);
  return motion;
}

PictureMotion tip_motion(const HandSettings& settings, const HandSample& sample, const Scaled& s) {
  const float pixels = sample.right_button ? 0.0f : settings.metres_per_pixel;
  const float stick = settings.stick_speed * s.seconds;
  return {pixels * s.dx + stick * s.stick_x, -pixels * s.dy - stick * s.stick_y, depth_of(settings, s)};
}

/// Left button closes progressively, the right trigger as far as it is pulled; let go, the handle opens unless the
/// ratchet holds it.
void move_handle(const HandSettings& settings, const HandSample& sample, float seconds, HandState& state) {
  float& handle = state.handle[state.led];
  bool& ratchet = state.ratchet[state.led];
  const Gamepad &now = sample.gamepad, &before = state.gamepad;
  const bool trigger_pressed = now.left_trigger > kTriggerPressed && !(before.left_trigger > kTriggerPressed);
  if (sample.pressed.has(Key::space) || trigger_pressed) {
    ratchet = !ratchet;
    state.opening = true;
  }
  const float pulled = std::clamp(finite(now.right_trigger), 0.0f, 1.0f);
  state.waiting &= sample.left_button || pulled > kTriggerTouched;
  if (state.waiting) return;
  if (sample.left_button) {
    handle = std::min(1.0f, handle + settings.close_per_second * seconds);
    state.opening = true;
  } else if (pulled > kTriggerTouched) {
    const float closing = std::min(pulled, handle + settings.close_per_second * seconds);
    const float opening = std::max(pulled, handle - settings.open_per_second * seconds);
    handle = pulled > handle ? closing : ratchet ? handle : opening;
    state.opening = true;
  } else if (state.opening && !ratchet) {
    handle = std::max(0.0f, handle - settings.open_per_second * seconds);
    state.opening = handle > 0;
  }
}

}  // namespace

const char* name_of(Key key) noexcept { return kKeyNames[std::size_t(key)]; }

HandCommand lead(const HandSettings& settings, const HandSample& sample, HandState& state) noexcept {
  choose_led(std::clamp(settings.instruments, 1, kMaxHands), sample, state);
  const Scaled s = scaled(settings, sample);
  HandCommand command;
  command.led = state.led;
  if (state.led == kScope) {
    command.scope = scope_motion(settings, sample, s);
  } else {
    command.tip = tip_motion(settings, sample, s);
    command.roll = roll_of(settings, sample, s);
    move_handle(settings, sample, s.seconds, state);
  }
  state.gamepad = sample.gamepad;
  return command;
}

std::array<float, 3> in_space(const PictureMotion& motion, const std::array<float, 3>& right,
                              const std::array<float, 3>& up, const std::array<float, 3>& shaft) noexcept {
  std::array<float, 3> result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = motion.right * right[i] + motion.up * up[i] + motion.in * shaft[i];
  return result;
}

std::span<const HelpLine> help() noexcept { return kHelp; }

}  // namespace trocar::devices
