// Fingers on a device: what two hands want to do in this picture, as one gamepad's or a mouse's and a keyboard's state,
// at the rates and resolutions of such devices and no quicker than fingers are. A thumb is in one place: while the left
// one is on the cross its stick rests, while the right one is on a button the other does. Three keys are held at most.
//
//   PadFingers fingers;
//   const devices::HandSample sample = fingers.play(settings, wish);   // once per picture
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <trocar/devices/both_hands.hpp>

namespace trocar::attempt::robots {

inline constexpr double kPicture = 1.0 / 60;  ///< [s]
using devices::kLeft;
using devices::kRight;

/// What closes the jaws does what: closes, opens valves, switches current.
enum class Grip { jaws, valves, electrode };

/// What is wanted of one hand: how far it still is from there.
struct HandWish {
  double right = 0, up = 0, in = 0;    ///< in the picture, along the shaft [m]
  double roll = 0;                     ///< clockwise seen from the hand [rad]
  double handle = 0, handle_seen = 0;  ///< wanted, as it is
  bool locked = false;
  Grip grip = Grip::jaws;
  bool squeeze = false, second = false;  ///< of valves: suction, water; of an electrode: coagulate, cut
};

struct ScopeWish {
  double right = 0, up = 0, in = 0, head = 0, post = 0;  ///< [rad], in [m]
};

struct Wish {
  std::array<HandWish, 2> side;
  bool look = false;  ///< the endoscope is to be led
  ScopeWish scope;
  bool declare = false, blue = false;  ///< blue: the foot switch, of jaws with current
  int menu = -1;                       ///< open the rack for this side
  int insert = -1;                     ///< bring this side's instrument into the view
};

/// A button that is pressed for a moment, and not again before it has been let go for as long.
class Tap {
 public:
  void ask() {
    if (m_left == 0) m_left = 2 * kPictures;
  }
  bool down() const { return m_left > kPictures; }
  bool busy() const { return m_left > 0; }
  void pass() { m_left = std::max(0, m_left - 1); }

 private:
  static constexpr int kPictures = 4;  // 67 ms down, 67 ms up
  int m_left = 0;
};

/// How fast one goes who is so far away: [per second], bounded.
inline double pace(double way, double still, double most) {
  constexpr double kGain = 5;  // [1/s]
  return std::fabs(way) < still ? 0.0 : std::clamp(kGain * way, -most, most);
}

inline constexpr double kStill = 0.0003, kStillIn = 0.0004, kStillRoll = 0.04,
                        kStillView = 0.01;  // [m] [m] [rad] [rad]

inline constexpr double kStillPost = 0.06;  // [rad]
inline constexpr double kFinger = 6;        // [1/s] of a trigger's way

/// The stick's way for a share of its full speed, in the 8 bits of most pads.
inline float tilt(const devices::HandSettings& settings, double share) {
  if (share == 0) return 0;
  const double dead = double(settings.stick_dead);
  const double way = dead + (1 - dead) * std::sqrt(std::min(1.0, std::fabs(share)));
  return float(std::copysign(std::round(127 * way) / 127, share));
}
inline float stick_share(const devices::HandSettings& settings, double way, double still, double full) {
  return tilt(settings, pace(way, still, full) / full);
}

class PadFingers {
 public:
  static constexpr const char* kName = "gamepad";
  static constexpr double kNeedleFar = 0.001, kNeedleTurned = 0.08;  ///< [m] [rad] that a needle may be behind

  devices::HandSample play(const devices::HandSettings& settings, const Wish& wish) {
    devices::HandSample sample;
    sample.dt = float(kPicture);
    devices::Gamepad& pad = sample.gamepad;
    const bool leads = !wish.look && !wish.declare && m_rest == 0;
    for (const int s : {kLeft, kRight}) squeeze(s, wish.side[std::size_t(s)], leads, pad);
    if (wish.declare) {
      m_rest = kRestPictures;
      for (const devices::Button b : {kShoulder[0], kShoulder[1], devices::Button::b}) pad.set(b);
    } else if (wish.look) {
      look(settings, wish.scope, pad);
    } else if (m_rest > 0) {
      --m_rest;  // the sticks come to rest, the shoulders are let go
    } else if (wish.menu >= 0) {
      pad.set(kShoulder[wish.menu]);
      m_menu.ask();
      if (m_menu.down()) pad.set(devices::Button::y);
    } else if (wish.insert >= 0 || m_bring.busy()) {
      if (wish.insert >= 0) pad.set(kShoulder[wish.insert]), m_bring.ask();
      if (m_bring.down()) pad.set(devices::Button::x);
    } else {
      lead(settings, wish, pad);
    }
    if (wish.blue && !wish.look) pad.set(devices::Button::a), pad.right_x = pad.right_y = 0;
    m_menu.pass(), m_bring.pass();
    for (Tap& tap : m_cross) tap.pass();
    return sample;
  }

 private:
  static constexpr devices::Button kShoulder[2] = {devices::Button::left_shoulder, devices::Button::right_shoulder};
  static constexpr devices::Button kCross[2] = {devices::Button::left, devices::Button::right};
  static constexpr int kRestPictures = 9, kDwell = 12;  // 0.15 s, 0.2 s on a shoulder at least

  void squeeze(int s, const HandWish& wish, bool leads, devices::Gamepad& pad) {
    float& trigger = s == kLeft ? pad.left_trigger : pad.right_trigger;
    if (wish.grip != Grip::jaws) {
      trigger = leads && wish.squeeze ? 1.0f : 0.0f;
      if (leads && wish.second) pad.set(kCross[s]);
      m_pull[std::size_t(s)] = 0;
      return;
    }
    double& pull = m_pull[std::size_t(s)];
    int& held = m_held[std::size_t(s)];
    held = wish.handle > 0.8 && wish.handle_seen > wish.handle - 0.05 ? held + 1 : 0;
    const bool lock = !wish.locked && held > kHeldLong, unlock = wish.locked && wish.handle < wish.handle_seen - 0.1;
    if (leads && (lock || unlock)) m_cross[std::size_t(s)].ask();
    int& stuck = m_stuck[std::size_t(s)];
    stuck = pull > 0.1 && wish.handle_seen < 0.02 ? stuck + 1 : 0;  // what was pulled before counts only anew
    if (stuck > kStuck) pull = 0;
    const double to = (wish.locked && !unlock) || stuck > kStuck ? 0.0 : wish.handle;
    pull += std::clamp(to - pull, -kFinger * kPicture, kFinger * kPicture);
    trigger = float(std::round(255 * pull) / 255);
    if (m_cross[std::size_t(s)].down()) pad.set(kCross[s]);
  }

  void look(const devices::HandSettings& settings, const ScopeWish& scope, devices::Gamepad& pad) {
    m_rest = kRestPictures;
    m_shifted = -1;
    pad.set(kShoulder[0]), pad.set(kShoulder[1]);
    const double view = double(settings.stick_view);
    pad.right_y = -stick_share(settings, scope.in, 0.001, double(settings.stick_speed));
    pad.right_x = stick_share(settings, scope.head, 0.03, double(settings.stick_roll));
    if (std::fabs(scope.post) > kStillPost)  // the left thumb on the cross
      pad.set(scope.post > 0 ? devices::Button::right : devices::Button::left);
    else
      pad.left_x = stick_share(settings, scope.right, kStillView, view),
      pad.left_y = -stick_share(settings, scope.up, kStillView, view);
  }

  /// The side whose stick goes deeper and rolls: whoever has farther to go that way than in the picture.
  void choose_shifted(const Wish& wish) {
    constexpr double kRollArm = 0.01;  // [m/rad] what a roll counts beside a way
    const auto across = [&](int s) {
      return std::hypot(wish.side[std::size_t(s)].right, wish.side[std::size_t(s)].up);
    };
    const auto along = [&](int s) {
      const HandWish& h = wish.side[std::size_t(s)];
      const double in = std::fabs(h.in) < kStillIn ? 0 : std::fabs(h.in);
      return std::max(in, std::fabs(h.roll) < kStillRoll ? 0 : kRollArm * std::fabs(h.roll));
    };
    if (++m_since < kDwell) return;
    const int was = m_shifted;
    if (m_shifted >= 0 && along(m_shifted) > 0.5 * across(m_shifted) && along(m_shifted) > 0 &&
        along(1 - m_shifted) < 3 * along(m_shifted))
      return;
    int next = -1;
    for (const int s : {kLeft, kRight})
      if (along(s) > 0 && along(s) > 0.8 * across(s) && s != was && (next < 0 || along(s) > along(next))) next = s;
    m_shifted = was >= 0 && next >= 0 ? -1 : next;  // never both shoulders, not even for a moment
    if (m_shifted != was) m_since = m_shifted < 0 && next >= 0 ? kDwell - 4 : 0;
  }

  void lead(const devices::HandSettings& settings, const Wish& wish, devices::Gamepad& pad) {
    choose_shifted(wish);
    if (m_shifted >= 0) pad.set(kShoulder[m_shifted]);
    const double speed = double(settings.stick_speed);
    for (const int s : {kLeft, kRight}) {
      const HandWish& h = wish.side[std::size_t(s)];
      float& x = s == kLeft ? pad.left_x : pad.right_x;
      float& y = s == kLeft ? pad.left_y : pad.right_y;
      if (m_shifted == s) {
        x = stick_share(settings, h.roll, kStillRoll, double(settings.stick_roll));
        y = -stick_share(settings, h.in, kStillIn, speed);
      } else {
        x = stick_share(settings, h.right, kStill, speed);
        y = -stick_share(settings, h.up, kStill, speed);
      }
    }
    if (pad.has(kCross[0]) || pad.has(kCross[1])) pad.left_x = pad.left_y = 0;
  }

  static constexpr int kHeldLong = 90;  // 1.5 s before one locks
  static constexpr int kStuck = 30;     // 0.5 s before one wonders and pulls anew
  std::array<double, 2> m_pull{};
  std::array<int, 2> m_held{}, m_stuck{};
  std::array<Tap, 2> m_cross{};
  Tap m_menu, m_bring;
  int m_rest = 0, m_shifted = -1, m_since = kDwell;
};

/// A pad that leads one instrument: tip by the left stick, deeper and roll by the right one, jaws by the right trigger.
class OneToolFingers {
 public:
  devices::Gamepad play(const devices::HandSettings& settings, const HandWish& wish) {
    devices::Gamepad pad;
    const double speed = double(settings.stick_speed);
    pad.left_x = stick_share(settings, wish.right, kStill, speed);
    pad.left_y = -stick_share(settings, wish.up, kStill, speed);
    pad.right_y = -stick_share(settings, wish.in, kStillIn, speed);
    pad.right_x = stick_share(settings, wish.roll, kStillRoll, double(settings.stick_roll));
    m_pull += std::clamp(wish.handle - m_pull, -kFinger * kPicture, kFinger * kPicture);
    pad.right_trigger = float(std::round(255 * m_pull) / 255);
    return pad;
  }

 private:
  double m_pull = 0;
};

/// A pad that leads the endoscope: where it looks by the left stick, in and the picture's turn by the right one, the
/// light post by the triggers.
class CameraFingers {
 public:
  devices::Gamepad play(const devices::HandSettings& settings, const ScopeWish& wish) const {
    devices::Gamepad pad;
    const double view = double(settings.stick_view);
    pad.left_x = stick_share(settings, wish.right, kStillView, view);
    pad.left_y = -stick_share(settings, wish.up, kStillView, view);
    pad.right_y = -stick_share(settings, wish.in, 0.001, double(settings.stick_speed));
    pad.right_x = stick_share(settings, wish.head, 0.03, double(settings.stick_roll));
    const double turn =
        pace(wish.post, kStillPost, double(settings.post_per_second)) / double(settings.post_per_second);
    (turn > 0 ? pad.right_trigger : pad.left_trigger) = float(std::round(255 * std::fabs(turn)) / 255);
    return pad;
  }
};

class MouseAndKeysFingers {
 public:
  static constexpr const char* kName = "mouse and keyboard";
  static constexpr double kNeedleFar = 0.002, kNeedleTurned = 0.15;  ///< [m] [rad]; no drag begins below kFarRoll

  devices::HandSample play(const devices::HandSettings& settings, const Wish& wish) {
    devices::HandSample sample;
    sample.dt = float(kPicture);
    if (wish.declare) sample.held.set(devices::Key::k);
    if (wish.look != m_looks && m_drag == 0) {  // a drag that is broken off is a click
      m_looks = wish.look;
      sample.pressed.set(wish.look ? devices::Key::zero : devices::Key::tab);
      m_rest = kReach;
    }
    if (m_menu.busy() || wish.menu >= 0) {
      if (wish.menu >= 0) m_menu.ask();
      sample.middle_button = m_menu.down();
      m_menu.pass();
    } else if (wish.insert >= 0 || m_bring.busy()) {
      // the key is for the hand last used, which is the one whose instrument was chosen
      if (wish.insert >= 0 && !m_bring.busy()) m_bring.ask(), sample.pressed.set(devices::Key::v);
      m_bring.pass();
    } else if (m_rest > 0) {
      --m_rest;
    } else if (m_looks) {
      look(settings, wish.scope, sample);
    } else {
      mouse(settings, wish.side[kRight], sample);
      keys(wish.side[kLeft], sample);
    }
    sample.left_button = m_left && !(m_switch && (m_rest > 0 || wish.look));
    sample.held.set(devices::Key::g, m_g);
    if (wish.blue) sample.held.set(devices::Key::b);
    m_lock.pass(), m_space.pass();
    return sample;
  }

 private:
  static constexpr int kStuck = 30;          // 0.5 s before one wonders and presses anew
  static constexpr int kReach = 15;          // 0.25 s for the left hand to find another key
  static constexpr double kMostPixels = 25;  // a picture, 1500 a second
  static constexpr double kFarRoll = 0.15;   // [rad]
  static constexpr int kDrag = 24;           // 0.4 s: shorter ones are clicks

  /// Whole pixels; what is left is kept for the next picture.
  static float pixels(double way, double per_pixel, double still, double& left) {
    if (std::fabs(way) < still) return float(left = 0);
    constexpr double kHand = 8 * kPicture;  // share of the way in a picture
    left += std::clamp(kHand * way / per_pixel, -kMostPixels, kMostPixels);
    const double whole = std::trunc(left);
    left -= whole;
    return float(whole);
  }
  /// A notch at a time, 15 a second at most; finer ones with Shift.
  float notch(const devices::HandSettings& settings, double way, devices::HandSample& sample) {
    const double step = double(settings.metres_per_notch), fine = double(settings.fine);
    if (m_wheel > 0) return --m_wheel, 0.0f;
    if (std::fabs(way) < 0.6 * fine * step) return 0;
    m_wheel = 3;
    if (std::fabs(way) < step) sample.held.set(devices::Key::shift);
    return way > 0 ? 1.0f : -1.0f;
  }
  /// Dragging with the right button. @return it does
  bool drag(double roll, double per_pixel, devices::HandSample& sample) {
    if (m_drag == 0 && std::fabs(roll) > kFarRoll) m_drag = 1;
    if (m_drag == 0) return false;
    ++m_drag;
    sample.right_button = true;
    sample.dx = pixels(roll, per_pixel, 0.02, m_roll);
    if (m_drag > kDrag && std::fabs(roll) < kStillRoll) m_drag = 0;
    return true;
  }

  void look(const devices::HandSettings& settings, const ScopeWish& scope, devices::HandSample& sample) {
    sample.wheel = notch(settings, scope.in, sample);
    if (std::fabs(scope.post) > 0.06) sample.held.set(scope.post > 0 ? devices::Key::r : devices::Key::f);
    if (drag(scope.head, double(settings.roll_per_pixel), sample)) return;
    sample.dx = pixels(scope.right, double(settings.view_per_pixel), kStillView, m_x);
    sample.dy = -pixels(scope.up, double(settings.view_per_pixel), kStillView, m_y);
  }

  /// How the button or key that closes goes, and when it locks: jaws that are half closed, or held for long.
  struct Closing {
    bool squeeze = false, lock = false;
  };
  static Closing closing(const HandWish& h, bool squeezes) {
    constexpr double kNear = 0.12;
    if (h.grip != Grip::jaws) return {h.squeeze, false};
    if (h.handle > 0.8) return {true, false};
    if (h.locked) {
      if (h.handle < h.handle_seen - kNear) return {squeezes, true};  // unlock it
      return {h.handle > h.handle_seen + kNear, false};
    }
    if (h.handle < 0.05 || h.handle_seen > h.handle + kNear) return {false, false};
    return {true, h.handle_seen > h.handle - 1.5 * kNear};  // it goes on closing while it is locked
  }

  void mouse(const devices::HandSettings& settings, const HandWish& h, devices::HandSample& sample) {
    sample.wheel = notch(settings, h.in, sample);
    if (m_lock.busy()) {  // a click without a motion
      sample.right_button = m_lock.down();
      m_left = m_left && m_lock.down();
      return;
    }
    const Closing c = closing(h, m_left);
    if (c.lock && m_drag == 0) {
      m_left = true;
      m_lock.ask();
      return;
    }
    m_stuck = c.squeeze && h.grip == Grip::jaws && h.handle_seen < 0.02 ? m_stuck + 1 : 0;
    m_left = c.squeeze && m_stuck < kStuck;
    if (m_stuck >= kStuck + 4) m_stuck = 0;
    m_switch = h.grip != Grip::jaws;
    if (drag(h.roll, double(settings.roll_per_pixel), sample)) return;
    sample.dx = pixels(h.right, double(settings.metres_per_pixel), kStill, m_x);
    sample.dy = -pixels(h.up, double(settings.metres_per_pixel), kStill, m_y);
  }

  /// @return held: until it is nearer than half of `far`
  static int key_of(double way, double far, int was) {
    const double still = was != 0 ? 0.5 * far : far;
    return std::fabs(way) < still || (was != 0 && (way > 0) != (was > 0)) ? 0 : way > 0 ? 1 : -1;
  }
  void keys(const HandWish& h, devices::HandSample& sample) {
    const Closing c = closing(h, m_g);
    if (c.lock && !m_space.busy()) {
      m_space.ask();
      sample.pressed.set(devices::Key::space);
    }
    m_g = c.squeeze;
    struct Axis {
      double way, far;
      devices::Key minus, plus;
    };
    const std::array<Axis, 4> axes{{{h.right, 0.0007, devices::Key::left, devices::Key::right},
                                    {h.up, 0.0007, devices::Key::down, devices::Key::up},
                                    {h.in, 0.0009, devices::Key::s, devices::Key::w},
                                    {h.roll, 0.1, devices::Key::q, devices::Key::e}}};
    int fingers = m_g ? 1 : 0;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      m_axis[i] = fingers < 3 ? key_of(axes[i].way, axes[i].far, m_axis[i]) : 0;
      if (m_axis[i] == 0) continue;
      ++fingers;
      sample.held.set(m_axis[i] > 0 ? axes[i].plus : axes[i].minus);
    }
  }

  bool m_looks = false, m_left = false, m_switch = false, m_g = false;
  double m_x = 0, m_y = 0, m_roll = 0;
  int m_wheel = 0, m_drag = 0, m_rest = 0, m_stuck = 0;
  std::array<int, 4> m_axis{};
  Tap m_lock, m_space, m_menu, m_bring;
};

}  // namespace trocar::attempt::robots
