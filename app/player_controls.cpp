#include <algorithm>
#include <cmath>
#include <iterator>

#include <imgui.h>

#include "player_parts.hpp"

namespace trocar::app {
namespace {

constexpr double kTurnPerPixel = 0.006;  // [rad]
constexpr double kZoomPerNotch = 0.12;

}  // namespace

/// Keys, gamepad and pointer; help and menu come and go.
void Player::listen(PlayerCommands& commands) {
  const devices::Gamepad& pad = m_window.gamepads().state();
  const WindowKeys& keys = m_window.keys();
  PlayerCommands ignored;
  if (!overlay()) {
    read_keys(m_window.typed(), m_window.picture_time(), commands);
    read_pointer(commands);
  }
  m_pad.read(pad, m_window.picture_time(), overlay() ? ignored : commands);
  m_picture_wanted = keys.picture;
  if (m_film) return;
  if (keys.help) m_help = !m_help;
  const bool back = keys.back && (overlay() || !pad.has(devices::Button::b));  // B means something else outside menus
  if (!back && !keys.pause) return;
  if (m_display)
    m_display = false;
  else if (m_help)
    m_help = false;
  else
    m_menu = !m_menu;
}

/// The mouse over the pictures: turns and shifts the outside camera, wherever that is shown.
void Player::read_pointer(PlayerCommands& c) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool over_small = m_inset && m_small.holds(io.MousePos.x, io.MousePos.y);
  const bool over = m_main.holds(io.MousePos.x, io.MousePos.y) && !io.WantCaptureMouse;
  const bool over_outside = over && (over_small ? m_endoscope : !m_endoscope);
  if (!io.MouseDown[0] && !io.MouseDown[1] && !io.MouseDown[2]) m_drag = Drag::none;
  if (over_outside && io.MouseClicked[0]) m_drag = io.KeyShift ? Drag::shift : Drag::turn;
  if (over_outside && (io.MouseClicked[1] || io.MouseClicked[2])) m_drag = Drag::shift;
  if (over && io.MouseDoubleClicked[0]) c.swap = true;
  if (over_outside && io.MouseWheel != 0) c.closer += kZoomPerNotch * double(io.MouseWheel);
  const double height = double(m_endoscope ? m_small.height : m_main.height);
  if (m_drag == Drag::turn) {
    c.turn_yaw -= kTurnPerPixel * double(io.MouseDelta.x);
    c.turn_pitch += kTurnPerPixel * double(io.MouseDelta.y);
  } else if (m_drag == Drag::shift) {
    c.pan_right -= 0.75 * double(io.MouseDelta.x) / height;
    c.pan_up += 0.75 * double(io.MouseDelta.y) / height;
  }
}

void Player::obey(const PlayerCommands& c) {
  obey_times(c);
  obey_cameras(c);
  if (c.picture) m_picture_wanted = true;
  if (c.film) start_film();
}

void Player::obey_times(const PlayerCommands& c) {
  if (c.toggle_play) {
    if (!m_playing && now() >= m_line.last()) seek(0);
    m_playing = !m_playing;
  }
  if (c.to_start) seek(0);
  if (c.to_end) seek(m_line.last());
  if (c.ticks != 0) {
    m_playing = false;
    seek(std::uint64_t(std::max(0.0, double(now()) + c.ticks)));
  }
  if (c.scrub != 0) {
    m_now = std::clamp(m_now + c.scrub * (m_line.to() - m_line.from()), 0.0, double(m_line.last()));
    m_asked_at = Clock::now();
  }
  if (c.next_mark)
    if (const TimelineMark* mark = next_mark(m_found.marks, now())) seek(mark->tick);
  if (c.previous_mark)
    if (const TimelineMark* mark = previous_mark(m_found.marks, now())) seek(mark->tick);
  if (c.faster) m_speed = next_speed(m_speed, true);
  if (c.slower) m_speed = next_speed(m_speed, false);
  if (c.zoom_in) m_line.zoom(0.5, m_now);
  if (c.zoom_out) m_line.zoom(2, m_now);
  if (c.show_all) m_line.show_all();
}

void Player::obey_cameras(const PlayerCommands& c) {
  const bool endoscope = m_endoscope, inset = m_inset;
  const int presets = int(std::size(kCameraPresets));
  int preset = c.preset;
  if (c.next_preset) preset = m_endoscope ? 1 : (m_preset + 1) % (presets + 1);  // 0: the endoscope, and round again
  if (preset == 0) m_endoscope = true;
  if (preset > 0 && preset <= presets) {
    m_endoscope = false;
    m_preset = preset;
    m_orbit = orbit_of(choice_of(kCameraPresets[preset - 1]), m_around);
  }
  if (c.swap) m_endoscope = !m_endoscope;
  if (c.inset) m_inset = !m_inset;
  const bool turned = c.turn_yaw != 0 || c.turn_pitch != 0 || c.pan_right != 0 || c.pan_up != 0 || c.closer != 0;
  if (turned) {
    m_orbit.turn(c.turn_yaw, c.turn_pitch);
    m_orbit.pan(c.pan_right * m_orbit.distance, c.pan_up * m_orbit.distance);
    m_orbit.zoom(std::exp(-c.closer));
    if (m_endoscope && !m_inset) m_endoscope = false;  // what is turned shall be seen
  }
  if (!turned && preset < 0 && endoscope == m_endoscope && inset == m_inset) return;
  m_asked_at = Clock::now();
  log_camera();
}

void Player::seek(std::uint64_t tick) {
  tick = std::min(tick, m_line.last());
  if (tick == now()) return;
  m_now = double(tick);
  m_asked_at = Clock::now();
}

void Player::play_on() {
  if (!m_playing) return;
  m_now += m_window.picture_time() * 1000 * m_speed;
  m_asked_at = Clock::now();
  if (m_now < double(m_line.last())) return;
  m_now = double(m_line.last());
  m_playing = false;
}

}  // namespace trocar::app
