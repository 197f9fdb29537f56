#include <algorithm>

#include <imgui.h>

#include "player_parts.hpp"

namespace trocar::app {
namespace {

constexpr std::uint64_t kNearEnough = 40;     // ticks: while playing an exact State so old is shown
constexpr double kRest = 0.3;                 // [s] without a change: drawn at full quality
constexpr std::uint64_t kExposureStep = 500;  // [ms] of a camera's time that a jump takes

}  // namespace

const sim::State& Player::state_to_show() {
  const std::uint64_t wanted = now();
  m_reel.look_at(wanted, m_playing);
  m_reel.refresh();
  const sim::State& exact = m_reel.exact();
  const bool trusted = m_reel.replays() && wanted < m_reel.differs_from();
  const bool late = m_playing && exact.tick <= wanted && wanted - exact.tick <= kNearEnough;
  m_exact = trusted && (exact.tick == wanted || late);
  return m_exact || m_footage.empty() ? exact : m_footage.at(wanted);
}

view::ViewOptions Player::view_now(bool endoscope, const render::Quality& quality) const {
  view::ViewOptions options = endoscope ? view::ViewOptions{} : view_of(m_orbit);
  options.quality = quality;
  options.styles = m_styles;
  return options;
}

/// The window's lower left corner is OpenGL's origin.
render::Target Player::target(const Area& a) const {
  render::Target t = render::Target::window(int(a.width), int(a.height));
  t.x = int(a.x);
  t.y = m_window.height() - int(a.y) - int(a.height);
  return t;
}

/// Draws it where it is not what was drawn last: quickly while things move, at full quality once they rest.
void Player::show_scene(const sim::State& state) {
  const double rested = std::chrono::duration<double>(Clock::now() - m_asked_at).count();
  const bool moving = m_playing || m_drag != Drag::none || rested < kRest;
  Drawn wanted{state.tick,        m_exact,        m_endoscope,
               m_inset,           m_orbit.yaw,    m_orbit.pitch,
               m_orbit.distance,  m_orbit.target, m_window.width(),
               m_window.height(), m_styles,       moving ? m_governor.quality() : render::Quality{}};
  if (!(wanted == m_drawn)) {
    const Clock::time_point start = Clock::now();
    draw_scene(state, wanted.quality);
    m_backdrop.copy(0, m_window.height() - int(m_main.height), int(m_main.width), int(m_main.height));
    m_drawn = wanted;
    if (moving) m_governor.frame_took(std::chrono::duration<double>(Clock::now() - start).count());
  }
  m_backdrop.draw(m_main);
}

void Player::draw_scene(const sim::State& state, const render::Quality& quality) {
  m_picture_clock += m_playing ? std::uint64_t(1000 * m_window.picture_time()) : kExposureStep;
  const auto draw = [&](bool endoscope, int eye, const Area& area) {
    view::ViewOptions options = view_now(endoscope, quality);
    options.eye_index = eye;
    options.picture_height = double(area.height);
    render::Frame frame = m_view.frame(state, options);
    frame.tick = m_picture_clock;
    render::draw_frame(*m_backend, frame, target(area));
  };
  draw(m_endoscope, m_endoscope ? kScopeEye : kOutsideEye, m_main);
  if (m_inset) draw(!m_endoscope, m_endoscope ? kOutsideEye : kScopeEye, m_small);
}

void Player::frame_inset() {
  ImDrawList& over = *ImGui::GetBackgroundDrawList();
  const float scale = m_window.scale();
  const auto label = [&](const Area& a, bool endoscope) {
    over.AddText({a.x + 8 * scale, a.y + 6 * scale}, IM_COL32(235, 235, 235, 220),
                 endoscope ? "endoscope, as recorded" : "from outside");
  };
  label(m_main, m_endoscope);
  if (!m_inset) return;
  over.AddRect({m_small.x, m_small.y}, {m_small.x + m_small.width, m_small.y + m_small.height},
               IM_COL32(200, 205, 212, 255), 0, 0, 1.5f * scale);
  label(m_small, !m_endoscope);
}

}  // namespace trocar::app
