#include <algorithm>
#include <cmath>
#include <utility>

#include <trocar/devices/mouse_keyboard.hpp>
#include <trocar/devices/readings.hpp>

namespace trocar::devices {
namespace {

constexpr std::array<const char*, std::size_t(Key::count)> kKeyNames = {
    "Tab", "1", "2", "3", "4", "0", "C", "Left",  "Right", "Up", "Down",  "PageUp", "PageDown",
    "W",   "S", "Q", "E", "R", "F", "G", "Enter", "V",     "X",  "Space", "Shift",  "A",
    "D",   "T", "B", "N", "H", "K", "I", "J",     "L",     "M",  "U",     "O"};

using Needs = HelpNeeds;
using Group = HelpGroup;

constexpr HelpLine kHelp[] = {
    {Device::keyboard, "1 2 3 4, Tab", "control this instrument, the next one; the others keep pose and grip",
     Group::choose, Needs::instrument},
    {Device::keyboard, "0 C", "control the endoscope", Group::choose, Needs::instrument},
    {Device::keyboard, "H", "both hands at once: on, off", Group::choose, Needs::two_instruments},
    {Device::keyboard, "X", "exchange the instrument, choose another hand", Group::choose, Needs::instrument},
    {Device::keyboard, "V", "bring the instrument into view", Group::choose, Needs::instrument},
    {Device::keyboard, "Left Right Up Down", "move the tip in the picture; turn the endoscope", Group::move,
     Needs::nothing},
    {Device::keyboard, "W S, PageUp PageDown", "deeper, back", Group::move, Needs::nothing},
    {Device::keyboard, "Q E", "roll the instrument, or the endoscope's picture", Group::move, Needs::nothing},
    {Device::keyboard, "R F", "turn the light post of the oblique endoscope", Group::move, Needs::oblique},
    {Device::keyboard, "I, M, J, L, O", "bend the wrist up, down, left, right in the picture; straighten it",
     Group::move, Needs::wrist},
    {Device::keyboard, "U", "hold it and move the mouse: bend the wrist", Group::move, Needs::wrist},
    {Device::keyboard, "Shift", "fine: a quarter of every motion; for clips close slowly with it", Group::move,
     Needs::nothing},
    {Device::keyboard, "G Enter", "close the jaws while it is held", Group::act, Needs::jaws},
    {Device::keyboard, "Space", "lock: the jaws stay closed; again: unlock", Group::act, Needs::jaws},
    {Device::keyboard, "A D", "suction-irrigator: water, suction, while it is held", Group::act, Needs::valves},
    {Device::keyboard, "A D", "injection needle: press, draw the plunger", Group::act, Needs::needle},
    {Device::keyboard, "Space", "injection needle: into its shaft, out of it", Group::act, Needs::needle},
    {Device::keyboard, "G, Space", "hook: coagulate, cut, while it is held", Group::act, Needs::hook},
    {Device::keyboard, "B N", "foot switch: blue coagulates, yellow cuts, while it is held", Group::act, Needs::energy},
    {Device::keyboard, "T", "wipe the lens; it takes eight seconds", Group::act, Needs::lens},
    {Device::keyboard, "K", "declare", Group::act, Needs::declares},
    {Device::mouse, "side buttons", "control the previous, the next instrument", Group::choose, Needs::instrument},
    {Device::mouse, "middle or right click", "choose hand, both hands, instrument, fine motion, pause", Group::choose,
     Needs::instrument},
    {Device::mouse, "move", "move the tip in the picture; turn the endoscope", Group::move, Needs::nothing},
    {Device::mouse, "wheel", "deeper, back", Group::move, Needs::nothing},
    {Device::mouse, "right drag", "roll the instrument, or the endoscope's picture", Group::move, Needs::nothing},
    {Device::mouse, "move with U held", "bend the wrist", Group::move, Needs::wrist},
    {Device::mouse, "left button", "close the jaws while it is held", Group::act, Needs::jaws},
    {Device::mouse, "left held, right click", "lock the jaws; the same again: unlock", Group::act, Needs::jaws},
    {Device::mouse, "left, right button", "suction-irrigator: suction, water", Group::act, Needs::valves},
    {Device::mouse, "left, right button", "injection needle: draw, press the plunger", Group::act, Needs::needle},
    {Device::mouse, "left held, right click", "injection needle: into its shaft, out of it", Group::act, Needs::needle},
    {Device::mouse, "left button", "hook: coagulate, while it is held", Group::act, Needs::hook},
    {Device::gamepad, "shoulders", "control the previous, the next instrument; the endoscope is among them",
     Group::choose, Needs::instrument},
    {Device::gamepad, "both shoulders and Y", "both hands at once: on, off", Group::choose, Needs::two_instruments},
    {Device::gamepad, "Y", "exchange the instrument, choose another hand", Group::choose, Needs::instrument},
    {Device::gamepad, "X", "bring the instrument into view", Group::choose, Needs::instrument},
    {Device::gamepad, "left stick", "move the tip in the picture; turn the endoscope", Group::move, Needs::nothing},
    {Device::gamepad, "cross, left stick pressed", "the same, fine; everything fine: on, off", Group::move,
     Needs::nothing},
    {Device::gamepad, "right stick", "up, down: deeper, back; sideways: roll", Group::move, Needs::nothing},
    {Device::gamepad, "right, left trigger", "endoscope: turn the light post", Group::move, Needs::oblique},
    {Device::gamepad, "right stick with A held", "bend the wrist", Group::move, Needs::wrist},
    {Device::gamepad, "right trigger", "close the jaws as far as it is pulled", Group::act, Needs::jaws},
    {Device::gamepad, "left trigger", "lock, unlock the jaws", Group::act, Needs::jaws},
    {Device::gamepad, "right, left trigger", "suction-irrigator: suction, water", Group::act, Needs::valves},
    {Device::gamepad, "right, left trigger", "hook: coagulate, cut", Group::act, Needs::hook},
    {Device::gamepad, "right, left trigger", "injection needle: draw, press the plunger", Group::act, Needs::needle},
    {Device::gamepad, "right stick pressed", "injection needle: into its shaft, out of it", Group::act, Needs::needle},
    {Device::gamepad, "A, right stick pressed", "foot switch: blue coagulates, yellow cuts", Group::act, Needs::energy},
    {Device::gamepad, "B", "wipe the lens", Group::act, Needs::lens},
    {Device::gamepad, "both shoulders and B", "declare", Group::act, Needs::declares},
};

constexpr float kLongestSample = 0.1f, kFirstSpeed = 0.2f;

/// A stick's way without its rest zone, the middle part made gentle.
float shaped(float way, float dead) {
  way = std::clamp(finite(way), -1.0f, 1.0f);
  const float size = std::abs(way);
  if (size <= dead) return 0;
  const float share = (size - dead) / (1 - dead);
  return std::copysign(share * share, way);
}

float key_axis(const KeySet& held, Key minus, Key plus) { return float(held.has(plus)) - float(held.has(minus)); }

// --- left-handed ---

/// What a right-handed person would have done.
HandSample as_right_handed(const HandSettings& settings, HandSample sample) {
  if (!settings.left_handed) return sample;
  std::swap(sample.left_button, sample.right_button);
  Gamepad& pad = sample.gamepad;
  std::swap(pad.left_x, pad.right_x);
  std::swap(pad.left_y, pad.right_y);
  std::swap(pad.left_trigger, pad.right_trigger);
  const bool left = pad.has(Button::left_shoulder), right = pad.has(Button::right_shoulder);
  pad.set(Button::left_shoulder, right);
  pad.set(Button::right_shoulder, left);
  return sample;
}

// --- which one is controlled ---

void choose_next_instrument(int instruments, HandState& state) {
  if (instruments == 0) return;
  choose(state.led == kScope ? state.last_instrument : (state.led + 1) % instruments, state);
}

/// Through all instruments and the scope, which stands behind the last.
void choose_neighbour(int step, int instruments, HandState& state) {
  const int places = instruments + 1, here = state.led == kScope ? instruments : state.led;
  const int there = (here + step + places) % places;
  choose(there == instruments ? kScope : there, state);
}

void choose_led(const HandSettings& settings, int instruments, const HandSample& sample, HandState& state) {
  if (state.led >= instruments) choose(kScope, state);  // a scene without this hand: the endoscope is there always
  for (int i = 0; i < instruments; ++i)
    if (sample.pressed.has(kNumberKeys[i])) choose(settings.left_handed ? instruments - 1 - i : i, state);
  if (sample.pressed.has(Key::tab)) choose_next_instrument(instruments, state);
  if (sample.pressed.has(Key::zero) || sample.pressed.has(Key::c)) choose(kScope, state);
  const bool previous = sample.back_button && !state.last.back_button;
  const bool next = sample.forward_button && !state.last.forward_button;
  if (previous || went_down(Button::left_shoulder, sample, state.last)) choose_neighbour(-1, instruments, state);
  if (next || went_down(Button::right_shoulder, sample, state.last)) choose_neighbour(+1, instruments, state);
}

// --- what it does ---

/// One sample's motions: pixels and notches already include Shift, keys and sticks are shares of their speeds times
/// seconds.
struct Scaled {
  float dx, dy, wheel, seconds;
  float key_x, key_y, key_in;
  float stick_x, stick_y, stick_in, stick_roll;
  float bend_x, bend_y;  ///< right, up: shares of the keys', of the stick's speed
};

/// Arrow keys begin slowly, so that a tap is a small step, and grow quicker while they are held.
float key_share(const HandSettings& settings, const KeySet& held, float seconds, HandState& state) {
  bool steering = false;
  for (const Key key : {Key::left, Key::right, Key::up, Key::down, Key::page_up, Key::page_down, Key::w, Key::s})
    steering |= held.has(key);
  state.steered_for = steering ? std::min(state.steered_for + seconds, settings.key_ramp) : 0.0f;
  return kFirstSpeed + (1 - kFirstSpeed) * state.steered_for / std::max(settings.key_ramp, 1e-3f);
}

Scaled scaled(const HandSettings& settings, const HandSample& sample, HandState& state) {
  const float fine = state.fine || sample.held.has(Key::shift) ? settings.fine : 1.0f;
  const float real = std::clamp(finite(sample.dt), 0.0f, kLongestSample), seconds = fine * real;
  const KeySet& held = sample.held;
  const Gamepad& pad = sample.gamepad;
  const auto stick = [&](float way) { return seconds * shaped(way, settings.stick_dead); };
  const auto cross = [&](Button minus, Button plus) {
    return seconds * settings.fine * (float(pad.has(plus)) - float(pad.has(minus)));
  };
  const float keys = seconds * key_share(settings, held, real, state);
  const float in = key_axis(held, Key::s, Key::w) + key_axis(held, Key::page_down, Key::page_up);
  return {fine * finite(sample.dx),
          fine * finite(sample.dy),
          fine * finite(sample.wheel),
          seconds,
          keys * key_axis(held, Key::left, Key::right),
          keys * key_axis(held, Key::up, Key::down),
          keys * std::clamp(in, -1.0f, 1.0f),
          stick(pad.left_x) + cross(Button::left, Button::right),
          stick(pad.left_y) + cross(Button::up, Button::down),
          -stick(pad.right_y),  // pushed away = deeper
          stick(pad.right_x),
          stick(pad.wrist_x),
          -stick(pad.wrist_y)};
}

/// Q and E, the right stick; dragging is added where it applies.
float roll_of(const HandSettings& settings, const HandSample& sample, const Scaled& s) {
  return s.seconds * settings.roll_per_second * key_axis(sample.held, Key::q, Key::e) +
         settings.stick_roll * s.stick_roll + (sample.right_button ? settings.roll_per_pixel * s.dx : 0.0f);
}

float depth_of(const HandSettings& settings, const Scaled& s) {
  return settings.metres_per_notch * s.wheel + settings.stick_speed * s.stick_in + settings.key_speed * s.key_in;
}

ScopeMotion scope_motion(const HandSettings& settings, const HandSample& sample, const Scaled& s) {
  const float pixels = sample.right_button ? 0.0f : settings.view_per_pixel;
  const float x = settings.invert_view_x ? -1.0f : 1.0f, y = settings.invert_view_y ? -1.0f : 1.0f;
  const Gamepad& pad = sample.gamepad;
  const float triggers = std::clamp(finite(pad.right_trigger) - finite(pad.left_trigger), -1.0f, 1.0f);
  ScopeMotion motion;
  motion.right = x * (pixels * s.dx + settings.stick_view * s.stick_x + settings.key_view * s.key_x);
  motion.up = -y * (pixels * s.dy + settings.stick_view * s.stick_y + settings.key_view * s.key_y);
  motion.in = depth_of(settings, s);
  motion.head = roll_of(settings, sample, s);
  motion.post = settings.post_per_second * s.seconds * (key_axis(sample.held, Key::f, Key::r) + triggers);
  return motion;
}

/// Of an instrument that bends: the right stick with A held, and the mouse with U held, mean the wrist.
HandSample without_wrist(HandSample sample) {
  if (sample.gamepad.has(Button::a)) {
    sample.gamepad.wrist_x += sample.gamepad.right_x;
    sample.gamepad.wrist_y += sample.gamepad.right_y;
    sample.gamepad.right_x = sample.gamepad.right_y = 0;
    sample.gamepad.set(Button::a, false);
  }
  if (sample.held.has(Key::u)) sample.dx = sample.dy = 0;
  return sample;
}

WristMotion wrist_motion(const HandSettings& settings, const HandSample& given, const Scaled& s) {
  const float fine = s.seconds / std::max(std::clamp(finite(given.dt), 0.0f, kLongestSample), 1e-9f);
  const float pixels = given.held.has(Key::u) ? fine * settings.bend_per_pixel : 0.0f;
  const float x = settings.invert_x ? -1.0f : 1.0f, y = settings.invert_y ? -1.0f : 1.0f;
  const float keys = settings.bend_per_second * s.seconds;
  return {
      x * (pixels * finite(given.dx) + settings.stick_bend * s.bend_x) + keys * key_axis(given.held, Key::j, Key::l),
      y * (-pixels * finite(given.dy) + settings.stick_bend * s.bend_y) + keys * key_axis(given.held, Key::m, Key::i),
      given.held.has(Key::o) || given.pressed.has(Key::o)};
}

PictureMotion tip_motion(const HandSettings& settings, const HandSample& sample, const Scaled& s) {
  const float pixels = sample.right_button ? 0.0f : settings.metres_per_pixel;
  const float x = settings.invert_x ? -1.0f : 1.0f, y = settings.invert_y ? -1.0f : 1.0f;
  return {x * (pixels * s.dx + settings.stick_speed * s.stick_x + settings.key_speed * s.key_x),
          -y * (pixels * s.dy + settings.stick_speed * s.stick_y + settings.key_speed * s.key_y),
          depth_of(settings, s)};
}

/// True when the right button was let go after a short press in one place.
bool right_tapped(const HandSettings& settings, const HandSample& sample, HandState& state) {
  const bool was = state.last.right_button;
  if (sample.right_button) {
    state.right_for = was ? state.right_for + finite(sample.dt) : 0.0f;
    state.right_moved = (was ? state.right_moved : 0.0f) + std::abs(finite(sample.dx)) + std::abs(finite(sample.dy));
    return false;
  }
  const bool tapped = was && state.right_for < settings.tap_seconds && state.right_moved < settings.tap_pixels;
  state.right_for = settings.tap_seconds;
  return tapped;
}

/// What closes jaws opens the suction, what rolls or locks them opens the water: a tube needs neither.
void open_valves(const HandSample& sample, HandState& state, HandCommand& command) {
  const Gamepad& pad = sample.gamepad;
  const bool suck = squeezes(sample) || sample.held.has(Key::d) || pad.right_trigger > kTriggerPressed;
  const bool irrigate = sample.right_button || sample.held.has(Key::a) || pad.left_trigger > kTriggerPressed;
  state.waiting &= suck || irrigate;
  // Nobody draws a plunger and presses it: both buttons of a mouse move the needle.
  if (state.waiting || (state.needle[state.led] && sample.right_button && sample.left_button)) return;
  command.suck = suck;
  command.irrigate = irrigate;
}

/// What locks jaws draws a needle into its shaft, and lets it out again; valves do not mind.
void move_needle(const HandSettings& settings, float seconds, HandState& state) {
  float& handle = state.handle[state.led];
  const float to = state.ratchet[state.led] ? 1.0f : 0.0f;
  handle += std::clamp(to - handle, -settings.open_per_second * seconds, settings.open_per_second * seconds);
}

/// What closes jaws coagulates with an electrode that has none, what locks jaws cuts.
void press_switches(const HandSample& sample, HandState& state, HandCommand& command) {
  const Gamepad& pad = sample.gamepad;
  const bool coagulate = squeezes(sample) || pad.right_trigger > kTriggerPressed;
  const bool cut = sample.held.has(Key::space) || pad.left_trigger > kTriggerPressed;
  state.waiting &= coagulate || cut;
  if (state.waiting) return;
  command.blue |= coagulate;
  command.yellow |= cut;
}

/// The left button or G closes progressively, the right trigger as far as it is pulled; let go, the handle opens unless
/// the ratchet holds it.
void move_handle(const HandSettings& settings, const HandSample& sample, float seconds, HandState& state) {
  float& handle = state.handle[state.led];
  const bool ratchet = state.ratchet[state.led];
  const bool squeezed = squeezes(sample);
  const float pulled = std::clamp(finite(sample.gamepad.right_trigger), 0.0f, 1.0f);
  state.waiting &= squeezed || pulled > kTriggerTouched;
  if (state.waiting) return;
  if (squeezed) {
    handle = std::min(1.0f, handle + settings.close_per_second * seconds);
    state.opening = true;
  } else if (pulled > kTriggerTouched) {
    // A handle that was left half closed is not opened by a trigger on its way to where it was left.
    if (!state.opening && pulled < handle - kTriggerTouched) return;
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

const std::vector<std::string>& button_names() {
  static const std::vector<std::string> names{
      "a",     "b",          "x",           "y",  "left_shoulder", "right_shoulder", "back",
      "start", "left_stick", "right_stick", "up", "right",         "down",           "left"};
  return names;
}

const char* name_of(Key key) noexcept { return kKeyNames[std::size_t(key)]; }

void choose(int led, HandState& state) noexcept {
  if (led == state.led) return;
  state.led = led;
  state.opening = false;
  state.waiting = true;
  if (led != kScope) state.last_instrument = led;
}

void toggle_ratchet(HandState& state) noexcept {
  if (state.led == kScope) return;
  state.ratchet[state.led] = !state.ratchet[state.led];
  state.opening = true;
}

void take_up(const HandSettings& settings, const HandSample& sample, HandState& state) noexcept {
  state.last = as_right_handed(settings, sample);
  state.opening = false;
  state.waiting = true;
  state.steered_for = 0;
  state.right_for = settings.tap_seconds;  // a press from before is no tap
}

HandCommand lead(const HandSettings& settings, const HandSample& given, HandState& state) noexcept {
  const HandSample all = as_right_handed(settings, given);
  choose_led(settings, std::clamp(settings.instruments, 0, kMaxHands), all, state);
  const bool bends = state.led != kScope && state.wrist[state.led];
  const HandSample sample = bends ? without_wrist(all) : all;
  if (went_down(Button::left_stick, sample, state.last)) state.fine = !state.fine;
  const Scaled s = scaled(settings, sample, state);
  const bool tapped = right_tapped(settings, sample, state);
  const bool with_left = sample.left_button || state.last.left_button;  // who lets both go at once locks, too
  const bool trigger =
      sample.gamepad.left_trigger > kTriggerPressed && !(state.last.gamepad.left_trigger > kTriggerPressed);
  const bool valves = state.led != kScope && state.valves[state.led];
  const bool needle = valves && state.needle[state.led];
  const bool jaws = state.led == kScope || !(valves || state.electrode[state.led]);
  HandCommand command;
  command.led = state.led;
  command.rack = sample.pressed.has(Key::x) || (sample.middle_button && !state.last.middle_button) ||
                 went_down(Button::y, sample, state.last) || (tapped && !valves && !with_left);
  command.insert = sample.pressed.has(Key::v) || went_down(Button::x, sample, state.last);
  command.wipe = sample.held.has(Key::t) || sample.pressed.has(Key::t) || sample.gamepad.has(Button::b);
  command.declare = sample.held.has(Key::k) || sample.pressed.has(Key::k);
  command.blue = sample.held.has(Key::b) || sample.gamepad.has(Button::a);
  command.yellow = sample.held.has(Key::n) || (!needle && sample.gamepad.has(Button::right_stick));
  if (state.led == kScope) {
    command.scope = scope_motion(settings, sample, s);
  } else {
    const bool locks = sample.pressed.has(Key::space) || (jaws && trigger) ||
                       ((jaws || needle) && tapped && with_left) ||
                       (needle && went_down(Button::right_stick, sample, state.last));
    if ((jaws || valves) && locks) toggle_ratchet(state);
    HandSample steered = sample;
    steered.right_button &= !valves;
    command.tip = tip_motion(settings, steered, s);
    command.roll = roll_of(settings, steered, s);
    if (bends) command.wrist = wrist_motion(settings, all, s);
    if (jaws)
      move_handle(settings, sample, s.seconds, state);
    else if (valves) {
      open_valves(sample, state, command);
      move_needle(settings, s.seconds, state);
    } else
      press_switches(sample, state, command);
  }
  state.last = all;
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
