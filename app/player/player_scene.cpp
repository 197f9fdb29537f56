#include <utility>

#include <trocar/core/error.hpp>

#include "player/player_parts.hpp"

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

view::ViewOptions Player::view_of_first(const render::Quality& quality) const {
  view::ViewOptions options = m_panes.options(m_panes.first().shows);
  options.quality = quality;
  options.styles = m_styles;
  options.picture_height = double(m_panes.first().area.height);
  return options;
}

/// Draws it where it is not what was drawn last: quickly while things move, at full quality once they rest.
void Player::show_scene(const sim::State& state) {
  const double rested = std::chrono::duration<double>(Clock::now() - m_asked_at).count();
  const bool moving = m_playing || m_panes.dragging() || rested < kRest;
  Drawn wanted{state.tick,      m_exact,  m_panes.panes(),
               m_panes.cameras, m_styles, moving ? m_governor.quality() : render::Quality{}};
  if (!(wanted == m_drawn)) {
    const Clock::time_point start = Clock::now();
    draw_scene(state, wanted.quality, !m_playing);
    m_drawn = std::move(wanted);
    if (moving) m_governor.frame_took(std::chrono::duration<double>(Clock::now() - start).count());
  }
  m_first.lay(window_target(m_panes.first().area, m_window.height()));
  m_panes.lay_others(m_window.height(), false);
}

void Player::draw_scene(const sim::State& state, const render::Quality& quality, bool all) {
  m_picture_clock += m_playing ? std::uint64_t(1000 * m_window.picture_time()) : kExposureStep;
  const Panes::Pane& first = m_panes.first();
  const int width = int(first.area.width), height = int(first.area.height);
  m_panes.draw_others({m_view, m_backend, state, m_picture_clock, quality, m_styles}, all);
  render::Frame frame = m_view.frame(state, view_of_first(quality));
  frame.tick = m_picture_clock;
  fit_to(first.area, frame);
  if (!m_options.eyes.on()) return render::draw_frame(m_backend, frame, m_first.target(width, height));
  const render::StereoPair pair = pictures::eyes_of(m_options.eyes, frame);
  render::draw_frame(m_backend, pair.left, m_first.target(width, height));
  render::draw_frame(m_backend, pair.right, m_first_other.target(width, height));
}

/// The second window, as it is wanted; closing it is wanting none.
void Player::show_elsewhere() {
  if (m_second && m_second->wants_to_close()) m_layout.elsewhere.reset();
  if (m_layout.elsewhere.has_value() != m_second.has_value())
    m_log.event("second-window", {{"open", m_layout.elsewhere.has_value()}});
  if (!m_layout.elsewhere) return m_second.reset();
  try {
    if (!m_second) m_second.emplace(m_window, "Trocar");
    const PaneCanvas* canvas = m_panes.canvas_elsewhere();
    m_second->show(canvas ? *canvas : m_first, m_panes.legend_of_pane(*m_layout.elsewhere));
  } catch (const core::EnvironmentLacks& lacks) {
    m_message = lacks.what();
    m_layout.elsewhere.reset();
  }
}

/// The window once more for the other eye, then both on one screen. Other panes, panels and menus lie on it.
void Player::draw_other_eye() {
  const render::Target whole = render::Target::window(m_window.width(), m_window.height());
  m_backend.keep_eye(render::Eye::left, whole);
  if (!m_film) {
    m_first_other.lay(window_target(m_panes.first().area, m_window.height()));
    m_panes.lay_others(m_window.height(), false);
    m_window.draw_panels_again();
  }
  m_backend.keep_eye(render::Eye::right, whole);
  m_backend.combine(*m_options.eyes.mode, whole);
}

}  // namespace trocar::app
