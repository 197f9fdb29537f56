#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <imgui.h>

#include <trocar/core/tick.hpp>

#include "player/player_parts.hpp"

namespace trocar::app {
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
  commands.next_layout = keys.layout && !m_film;
  commands.second_window = keys.second && !m_film;
  if (m_film) return;
  if (keys.help) m_help = !m_help;
  const bool back = keys.back && (overlay() || !pad.has(devices::Button::b));  // B means something else outside menus
  if (!back && !keys.pause) return;
  if (m_display || m_views)
    m_display = m_views = false;
  else if (m_help)
    m_help = false;
  else
    m_menu = !m_menu;
}

/// The mouse over the pictures: turns and shifts the camera of the pane that it is in.
void Player::read_pointer(PlayerCommands& c) {
  const Panes::Pane* under = m_panes.under_pointer();
  if (under && ImGui::GetIO().MouseDoubleClicked[0]) c.to_front = under->shows;
  if (under && ImGui::IsAnyMouseDown() && under->shows != PaneShows::endoscope) m_led = under->shows;
  c.moved_by_pointer = m_panes.listen();
}

void Player::obey(const PlayerCommands& c) {
  obey_times(c);
  obey_cameras(c);
  if (c.picture) m_picture_wanted = true;
  if (c.film) start_film();
  if (c.leave) m_end = PlayerEnd::back;
  if (c.now_you) m_end = PlayerEnd::now_you;
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
    if (const attempt::TimelineMark* mark = attempt::next_mark(m_found.marks, now())) seek(mark->tick);
  if (c.previous_mark)
    if (const attempt::TimelineMark* mark = attempt::previous_mark(m_found.marks, now())) seek(mark->tick);
  using Kind = attempt::TimelineMark::Kind;
  if (c.next_step) {
    if (const attempt::TimelineMark* mark = attempt::next_mark(m_found.marks, now(), Kind::step)) seek(mark->tick);
  }
  if (c.previous_step) {
    const attempt::TimelineMark* mark = attempt::previous_mark(m_found.marks, now(), Kind::step);
    seek(mark ? mark->tick : 0);
  }
  if (c.speed > 0) m_speed = c.speed;
  if (c.captions) m_show_captions = !m_show_captions;
  if (c.faster) m_speed = attempt::next_speed(m_speed, true);
  if (c.slower) m_speed = attempt::next_speed(m_speed, false);
  if (c.zoom_in) m_line.zoom(0.5, m_now);
  if (c.zoom_out) m_line.zoom(2, m_now);
  if (c.show_all) m_line.show_all();
}

void Player::obey_cameras(const PlayerCommands& c) {
  const LayoutChoice before = m_layout;
  const int presets = int(std::size(pictures::kCameraPresets));
  int preset = c.preset;
  if (c.next_preset) preset = endoscope() ? 1 : (m_preset + 1) % (presets + 1);  // 0: the endoscope, and round again
  if (preset == 0) m_layout.put(0, PaneShows::endoscope);
  if (preset > 0 && preset <= presets) {
    m_layout.put(0, PaneShows::outside);
    m_preset = preset;
    m_led = PaneShows::outside;
    m_panes.cameras.outside = pictures::orbit_of(pictures::choice_of(pictures::kCameraPresets[preset - 1]), m_around);
  }
  if (c.to_front && *c.to_front != m_layout.panes[0])
    m_layout.put(0, *c.to_front);
  else if (c.swap || c.to_front)
    m_layout.put(0, m_layout.panes[1]);
  if (c.inset) m_layout.layout = m_layout.layout == Layout::one ? Layout::corner : Layout::one;
  if (c.next_layout) m_layout.layout = after(m_layout.layout);
  if (c.second_window) m_layout.elsewhere = m_layout.elsewhere ? std::nullopt : std::optional(PaneShows::endoscope);
  const bool turned = turn_camera(c);
  if (!turned && !c.moved_by_pointer && preset < 0 && m_layout == before) return;
  m_asked_at = Clock::now();
  log_camera();
}

/// By keys and sticks: the camera that the pointer was last in, if it is shown, else the outside one.
bool Player::turn_camera(const PlayerCommands& c) {
  if (c.turn_yaw == 0 && c.turn_pitch == 0 && c.pan_right == 0 && c.pan_up == 0 && c.closer == 0) return false;
  if (!m_layout.shows(m_led)) m_led = PaneShows::outside;
  m_panes.turn(m_led, c.turn_yaw, c.turn_pitch);
  m_panes.shift(m_led, c.pan_right, c.pan_up);
  m_panes.closer(m_led, c.closer);
  if (!m_layout.shows(m_led)) m_layout.put(0, m_led);  // what is turned shall be seen
  return true;
}

void Player::seek(std::uint64_t tick) {
  tick = std::min(tick, m_line.last());
  if (tick == now()) return;
  m_now = double(tick);
  m_asked_at = Clock::now();
}

void Player::play_on() {
  if (!m_playing) return;
  if (std::exchange(m_first_picture, false)) return;  // the time before it was the loading
  m_now += m_window.picture_time() * double(core::kTicksPerSecond) * m_speed;
  m_asked_at = Clock::now();
  if (m_now < double(m_line.last())) return;
  m_now = double(m_line.last());
  m_playing = false;
}

}  // namespace trocar::app
