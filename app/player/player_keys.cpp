#include "player/player_keys.hpp"

#include <cmath>

#include <imgui.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <trocar/attempt/timeline.hpp>
#include <trocar/core/tick.hpp>

namespace trocar::app {
namespace {

constexpr double kTurnRate = 1.4, kPanRate = 0.6, kZoomRate = 1.2;  // a second, keys and sticks
constexpr double kScrubRate = 0.5;                                  // visible stretches a second, stick at its end
constexpr double kDead = 0.15;                                      // share of a stick's way that is rest
constexpr double kRepeatAfter = 0.4, kRepeatEvery = 0.08;           // [s]
constexpr int kSecondOfTicks = int(core::kTicksPerSecond);          // [ticks]

constexpr double kTap = 0.05;  // [s] a key that was only tapped counts as held so long

double held(int key) { return ImGui::IsKeyDown(key) ? 1 : 0; }

double beyond_rest(float stick) {
  const double size = std::fabs(double(stick));
  return size <= kDead ? 0 : std::copysign((size - kDead) / (1 - kDead), double(stick));
}

/// The keys that turn, shift and bring near the outside camera. @param amount [s]
void move_camera(int key, double amount, PlayerCommands& c) {
  switch (key) {
    case GLFW_KEY_A:
      c.turn_yaw -= kTurnRate * amount;
      break;
    case GLFW_KEY_D:
      c.turn_yaw += kTurnRate * amount;
      break;
    case GLFW_KEY_W:
      c.turn_pitch += kTurnRate * amount;
      break;
    case GLFW_KEY_S:
      c.turn_pitch -= kTurnRate * amount;
      break;
    case GLFW_KEY_J:
      c.pan_right -= kPanRate * amount;
      break;
    case GLFW_KEY_L:
      c.pan_right += kPanRate * amount;
      break;
    case GLFW_KEY_I:
      c.pan_up += kPanRate * amount;
      break;
    case GLFW_KEY_K:
      c.pan_up -= kPanRate * amount;
      break;
    case GLFW_KEY_E:
      c.closer += kZoomRate * amount;
      break;
    case GLFW_KEY_Q:
      c.closer -= kZoomRate * amount;
      break;
    default:
      break;
  }
}
constexpr int kCameraKeys[] = {GLFW_KEY_A, GLFW_KEY_D, GLFW_KEY_W, GLFW_KEY_S, GLFW_KEY_J,
                               GLFW_KEY_L, GLFW_KEY_I, GLFW_KEY_K, GLFW_KEY_E, GLFW_KEY_Q};

void obey_key(TypedKey typed, PlayerCommands& c) {
  const int step = typed.mods & GLFW_MOD_SHIFT ? kSecondOfTicks : int(attempt::kFrameTicks);
  switch (typed.key) {
    case GLFW_KEY_RIGHT:
      c.ticks += step;
      break;
    case GLFW_KEY_LEFT:
      c.ticks -= step;
      break;
    case GLFW_KEY_PERIOD:
      ++c.ticks;
      break;
    case GLFW_KEY_COMMA:
      --c.ticks;
      break;
    case GLFW_KEY_SPACE:
      c.toggle_play = !c.toggle_play;
      break;
    case GLFW_KEY_HOME:
      c.to_start = true;
      break;
    case GLFW_KEY_END:
      c.to_end = true;
      break;
    case GLFW_KEY_PAGE_UP:
      (typed.mods & GLFW_MOD_SHIFT ? c.previous_step : c.previous_mark) = true;
      break;
    case GLFW_KEY_PAGE_DOWN:
      (typed.mods & GLFW_MOD_SHIFT ? c.next_step : c.next_mark) = true;
      break;
    case GLFW_KEY_T:
      c.captions = !c.captions;
      break;
    case GLFW_KEY_UP:
      c.faster = true;
      break;
    case GLFW_KEY_DOWN:
      c.slower = true;
      break;
    case GLFW_KEY_EQUAL:
    case GLFW_KEY_KP_ADD:
      c.zoom_in = true;
      break;
    case GLFW_KEY_MINUS:
    case GLFW_KEY_KP_SUBTRACT:
      c.zoom_out = true;
      break;
    case GLFW_KEY_0:
    case GLFW_KEY_KP_0:
      c.show_all = true;
      break;
    case GLFW_KEY_C:
      c.swap = !c.swap;
      break;
    case GLFW_KEY_V:
      c.inset = !c.inset;
      break;
    case GLFW_KEY_X:
      c.film = true;
      break;
    default:
      if (typed.key >= GLFW_KEY_1 && typed.key <= GLFW_KEY_5) c.preset = typed.key - GLFW_KEY_1;
      if (typed.key >= GLFW_KEY_KP_1 && typed.key <= GLFW_KEY_KP_5) c.preset = typed.key - GLFW_KEY_KP_1;
  }
}

}  // namespace

void read_keys(const std::vector<TypedKey>& typed, double dt, PlayerCommands& c) {
  for (const TypedKey& key : typed) {
    if (key.mods & (GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER)) continue;
    obey_key(key, c);
    if (!ImGui::IsKeyDown(key.key)) move_camera(key.key, kTap, c);
  }
  for (const int key : kCameraKeys) move_camera(key, dt * held(key), c);
}

void PadReader::read(const devices::Gamepad& pad, double dt, PlayerCommands& c) {
  using devices::Button;
  const auto pressed = [&](Button b) { return pad.has(b) && !m_last.has(b); };
  const bool shifted = double(pad.left_trigger) > 0.5;
  c.toggle_play |= pressed(Button::a);
  c.next_preset |= pressed(Button::b);
  c.inset |= pressed(Button::x);
  c.swap |= pressed(Button::y);
  c.previous_mark |= pressed(Button::left_shoulder);
  c.next_mark |= pressed(Button::right_shoulder);
  c.faster |= pressed(Button::up);
  c.slower |= pressed(Button::down);
  c.picture |= pressed(Button::left_stick);
  c.show_all |= pressed(Button::right_stick);

  const int way = int(pad.has(Button::right)) - int(pad.has(Button::left));
  const int step = way * (shifted ? 1 : int(attempt::kFrameTicks));
  if (pressed(Button::right) || pressed(Button::left)) {
    c.ticks += step;
    m_held = 0;
    m_repeats = kRepeatAfter;
  } else if (way != 0) {
    for (m_held += dt; m_held >= m_repeats; m_repeats += kRepeatEvery) c.ticks += step;
  }

  const double x = beyond_rest(pad.left_x), right = beyond_rest(pad.right_x), up = -beyond_rest(pad.right_y);
  c.scrub += kScrubRate * dt * x * x * x;  // small motions are for small ways
  if (shifted) {
    c.pan_right += kPanRate * dt * right;
    c.pan_up += kPanRate * dt * up;
  } else {
    c.turn_yaw += kTurnRate * dt * right;
    c.turn_pitch += kTurnRate * dt * up;
  }
  c.closer += kZoomRate * dt * double(pad.right_trigger) * (shifted ? -1 : 1);
  m_last = pad;
}

}  // namespace trocar::app
