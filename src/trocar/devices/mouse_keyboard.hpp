// One mouse, one keyboard or one gamepad for several instruments: one hand at a time is controlled, the others keep
// pose and grip. Each of the three devices is enough alone. Pure logic without a window: the program fills a HandSample
// from its events, once per picture, and gets what the led instrument or the endoscope should do, in the picture's
// directions.
//
//   HandState state;                                       // lives as long as the session
//   const HandCommand command = lead(settings, sample, state);
//   if (command.led == kScope) turn the scope by command.scope;
//   else move tip[command.led] by in_space(command.tip, camera_right, camera_up, shaft), turn it by command.roll;
//   handle[i] = state.handle[i]                            // of every instrument, led or not
//   if (command.irrigate) open that valve of the led one
//   if (command.rack) show which hands and instruments there are to choose from
//
// help() is the table of keys that the window shows. Two hands that move at the same time:
// both_hands.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace trocar::devices {

inline constexpr int kMaxHands = 4;  ///< instruments that can be controlled
inline constexpr int kScope = -1;    ///< in place of an instrument's number: the endoscope

enum class Device : std::uint8_t { keyboard, mouse, gamepad };

enum class Key : std::uint8_t {
  tab,
  one,
  two,
  three,
  four,
  zero,
  c,
  left,
  right,
  up,
  down,
  page_up,
  page_down,
  w,
  s,
  q,
  e,
  r,
  f,
  g,
  enter,
  v,
  x,
  space,
  shift,
  a,
  d,
  t,
  b,
  n,
  h,
  k,
  i,
  j,
  l,
  m,
  u,
  o,
  count
};
const char* name_of(Key key) noexcept;  ///< as help() writes it

class KeySet {
 public:
  constexpr bool has(Key key) const noexcept { return (m_bits >> int(key)) & 1; }
  constexpr bool any() const noexcept { return m_bits != 0; }
  constexpr void set(Key key, bool on = true) noexcept {
    m_bits = on ? m_bits | std::uint64_t(1) << int(key) : m_bits & ~(std::uint64_t(1) << int(key));
  }

 private:
  std::uint64_t m_bits = 0;
};

/// Buttons by the names that most pads print on them; `a` is the lower, `b` the right, `x` the left, `y` the upper one.
enum class Button : std::uint8_t {
  a,
  b,
  x,
  y,
  left_shoulder,
  right_shoulder,
  back,
  start,
  left_stick,
  right_stick,
  up,
  right,
  down,
  left,
  count
};

/// "a", "left_shoulder": in Button's order.
const std::vector<std::string>& button_names();

/// Sticks -1..1, right and down positive as consoles report them; triggers 0..1. All 0 without a gamepad. No gamepad
/// has wrist axes: another device may (attempt/inputs/input_map.hpp).
struct Gamepad {
  float left_x = 0, left_y = 0, right_x = 0, right_y = 0, left_trigger = 0, right_trigger = 0;
  std::uint32_t buttons = 0;
  float wrist_x = 0, wrist_y = 0;

  constexpr bool has(Button b) const noexcept { return (buttons >> int(b)) & 1; }
  constexpr void set(Button b, bool on = true) noexcept {
    buttons = on ? buttons | 1u << int(b) : buttons & ~(1u << int(b));
  }
};

/// What the devices did since the last sample.
struct HandSample {
  float dt = 0;          ///< time since the last sample [s]; longer ones count as 0.1
  float dx = 0, dy = 0;  ///< mouse motion [px], right and down positive
  float wheel = 0;       ///< notches, away from the user positive
  bool left_button = false, right_button = false;
  bool middle_button = false, back_button = false, forward_button = false;  ///< the wheel pressed; the side buttons
  KeySet held;                                                              ///< down now
  KeySet pressed;  ///< went down since the last sample, even if up again
  Gamepad gamepad;
};

/// Motion of a tip in the picture [m]: to the right, upwards, and along the shaft into the patient.
struct PictureMotion {
  float right = 0, up = 0, in = 0;
};

/// How an instrument that bends bends, in the picture's directions [rad].
struct WristMotion {
  float right = 0, up = 0;
  bool straighten = false;  ///< all of it, as quickly as it goes
};

/// How the endoscope turns about its trocar. Angles [rad], in the picture's directions.
struct ScopeMotion {
  float right = 0, up = 0;  ///< where the view goes
  float in = 0;             ///< towards the organs [m]
  float head = 0;           ///< roll of the picture, clockwise positive
  float post = 0;           ///< light post of an oblique scope, clockwise positive
};

/// For the led one only; everything is a change within this sample.
struct HandCommand {
  int led = 0;  ///< instrument 0.., or kScope
  PictureMotion tip;
  float roll = 0;  ///< [rad], clockwise seen from the hand positive
  WristMotion wrist;
  ScopeMotion scope;
  bool rack = false;                    ///< asked for what there is to choose from: hands, instruments
  bool insert = false;                  ///< asked to bring the led instrument into the view
  bool irrigate = false, suck = false;  ///< valves of the led instrument, as long as they are held
  bool wipe = false;                    ///< asked for a clean lens, whatever is controlled
  bool declare = false;                 ///< "this is what was to be shown", whatever is controlled
  bool blue = false, yellow = false;    ///< foot switches as long as they are held, whatever is controlled
};

/// How much a device's motion means.  Our choice: 10 cm across a picture of 1000 px.
struct HandSettings {
  int instruments = 2;             ///< 0..kMaxHands; with 0 the endoscope is controlled
  float metres_per_pixel = 1e-4f;  ///< tip
  float metres_per_notch = 2e-3f;  ///< tip and scope, along the shaft
  float roll_per_pixel = 8e-3f;    ///< [rad], dragging with the right button
  float roll_per_second = 1.6f;    ///< [rad/s], Q and E
  float view_per_pixel = 1e-3f;    ///< [rad], scope
  float post_per_second = 1.0f;    ///< [rad/s], R and F
  float close_per_second = 1.6f;   ///< handle, a share of its way; fine: slow enough for a clip
  float open_per_second = 4.0f;
  float bend_per_pixel = 5e-3f;  ///< [rad], wrist, the mouse with U held
  float bend_per_second = 1.0f;  ///< [rad/s], wrist, keys
  float stick_bend = 1.5f;       ///< [rad/s], wrist, stick at its end
  float key_speed = 0.05f;       ///< [m/s], tip, arrow keys held for key_ramp or longer; they begin with a fifth of it
  float key_view = 0.5f;         ///< [rad/s], scope
  float key_ramp = 0.7f;         ///< [s]
  float stick_speed = 0.05f;     ///< [m/s], stick at its end
  float stick_roll = 2.0f;       ///< [rad/s]
  float stick_view = 0.6f;       ///< [rad/s], scope
  float stick_dead = 0.12f;      ///< share of a stick's way that is rest
  float fine = 0.25f;            ///< Shift, the gamepad's crossed buttons
  float tap_seconds = 0.3f;      ///< a right press is a tap when it is shorter than this ...
  float tap_pixels = 6;          ///< ... and moves less
  bool left_handed = false;      ///< mouse buttons, gamepad sides and the order of the hands are exchanged
  bool invert_x = false, invert_y = false;            ///< tip
  bool invert_view_x = false, invert_view_y = false;  ///< scope
};

/// What must be remembered between samples.
struct HandState {
  int led = 0;                            ///< instrument or kScope
  int last_instrument = 0;                ///< the one that Tab returns to
  std::array<float, kMaxHands> handle{};  ///< 0 open .. 1 closed, of every instrument
  std::array<bool, kMaxHands> ratchet{};  ///< holds the handle when it is released
  /// Set by the program: this instrument has valves in place of jaws, so that what closes jaws opens them.
  std::array<bool, kMaxHands> valves{};
  /// ... of these: it has a needle that goes in and out, and a plunger where others have valves.
  std::array<bool, kMaxHands> needle{};
  /// ... this one is bare metal without jaws, a hook: what closes jaws coagulates, what locks them cuts, while it is
  /// held. A thumb on a stick, a hand on arrow keys could press no foot switch meanwhile.
  std::array<bool, kMaxHands> electrode{};
  /// ... this one bends: with A held the right stick bends it, and presses no foot switch.
  std::array<bool, kMaxHands> wrist{};
  bool opening = false;   ///< the led handle was let go: it opens. A hand that was only chosen keeps its grip.
  bool fine = false;      ///< every motion is a fine one, as with Shift held
  bool waiting = false;   ///< what was already squeezed when this one was chosen must be let go first
  float steered_for = 0;  ///< how long an arrow key has been down [s]
  float right_for = 0;    ///< how long the right button has been down [s]
  float right_moved = 0;  ///< and how far the mouse went meanwhile [px]
  HandSample last;        ///< as used, to notice presses
};

/// One sample: moves `state` on and reports what the controlled one does.
HandCommand lead(const HandSettings& settings, const HandSample& sample, HandState& state) noexcept;

/// Leads hand `hand` from now on (a number, or kScope), as if its key had been pressed.
void choose(int hand, HandState& state) noexcept;
/// The ratchet of the led hand on or off, as Space does.
void toggle_ratchet(HandState& state) noexcept;
/// After a pause, a menu or a lost device: whatever is held down now counts as old, and every handle keeps its grip
/// until it is squeezed again. Call with the sample that begins the new stretch.
void take_up(const HandSettings& settings, const HandSample& sample, HandState& state) noexcept;

/// A tip's motion in space, from the unit vectors of the picture and of the shaft (port to tip).
std::array<float, 3> in_space(const PictureMotion& motion, const std::array<float, 3>& right,
                              const std::array<float, 3>& up, const std::array<float, 3>& shaft) noexcept;

/// What a line of help is good for: an exercise without it does not show the line.
enum class HelpNeeds : std::uint8_t {
  nothing,
  instrument,
  two_instruments,
  jaws,
  clips,
  valves,
  needle,
  hook,
  energy,
  wrist,
  oblique,
  lens,  ///< that fogs
  declares
};
enum class HelpGroup : std::uint8_t { choose, move, act };

struct HelpLine {
  Device device;
  const char* keys;
  const char* action;
  HelpGroup group = HelpGroup::act;
  HelpNeeds needs = HelpNeeds::nothing;
};
std::span<const HelpLine> help() noexcept;

}  // namespace trocar::devices
