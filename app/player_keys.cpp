#include "player_keys.hpp"

#include <cmath>

#include <imgui.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "player_timeline.hpp"

namespace trocar::app {
namespace {

constexpr double kTurnRate = 1.4, kPanRate = 0.6, kZoomRate = 1.2;  // a second, keys and sticks
constexpr double kScrubRate = 0.5;                                  // visible stretches a second, stick at its end
constexpr double kDead = 0.15;                                      // share of a stick's way that is rest
constexpr double kRepeatAfter = 0.4, kRepeatEvery = 0.08;           // [s]
constexpr int kSecond = 1000;                                       // [ticks]

bool went_down(int key, bool repeated = false) { return ImGui::IsKeyPressed(key, repeated); }
double held(int key) { return ImGui::IsKeyDown(key) ? 1 : 0; }

double beyond_rest(float stick) {
  const double size = std::fabs(double(stick));
  return size <= kDead ? 0 : std::copysign((size - kDead) / (1 - kDead), double(stick));
}

void read_camera_keys(double dt, PlayerCommands& c) {
  c.turn_yaw += kTurnRate * dt * (held(GLFW_KEY_D) - held(GLFW_KEY_A));
  c.turn_pitch += kTurnRate * dt * (held(GLFW_KEY_W) - held(GLFW_KEY_S));
  c.pan_right += kPanRate * dt * (held(GLFW_KEY_L) - held(GLFW_KEY_J));
  c.pan_up += kPanRate * dt * (held(GLFW_KEY_I) - held(GLFW_KEY_K));
  c.closer += kZoomRate * dt * (held(GLFW_KEY_E) - held(GLFW_KEY_Q));
  for (int i = 0; i < 5; ++i)
    if (went_down(GLFW_KEY_1 + i) || went_down(GLFW_KEY_KP_1 + i)) c.preset = i;
  c.swap |= went_down(GLFW_KEY_C);
  c.inset |= went_down(GLFW_KEY_V);
}

}  // namespace

void read_keys(double dt, PlayerCommands& c) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.KeyCtrl || io.KeyAlt || io.KeySuper) return;
  const int step = io.KeyShift ? kSecond : int(kFrameTicks);
  c.ticks += step * (int(went_down(GLFW_KEY_RIGHT, true)) - int(went_down(GLFW_KEY_LEFT, true)));
  c.ticks += int(went_down(GLFW_KEY_PERIOD, true)) - int(went_down(GLFW_KEY_COMMA, true));
  c.toggle_play |= went_down(GLFW_KEY_SPACE);
  c.to_start |= went_down(GLFW_KEY_HOME);
  c.to_end |= went_down(GLFW_KEY_END);
  c.previous_mark |= went_down(GLFW_KEY_PAGE_UP, true);
  c.next_mark |= went_down(GLFW_KEY_PAGE_DOWN, true);
  c.faster |= went_down(GLFW_KEY_UP);
  c.slower |= went_down(GLFW_KEY_DOWN);
  c.zoom_in |= went_down(GLFW_KEY_EQUAL, true) || went_down(GLFW_KEY_KP_ADD, true);
  c.zoom_out |= went_down(GLFW_KEY_MINUS, true) || went_down(GLFW_KEY_KP_SUBTRACT, true);
  c.show_all |= went_down(GLFW_KEY_0) || went_down(GLFW_KEY_KP_0);
  c.film |= went_down(GLFW_KEY_X);
  read_camera_keys(dt, c);
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
  const int step = way * (shifted ? 1 : int(kFrameTicks));
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
