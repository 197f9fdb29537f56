#include "player/player_parts.hpp"

namespace trocar::app {

/// What can be pressed, and where, for tests that drive the real window.
void Player::log_widgets() {
  const std::vector<ui::Widget> widgets = ui::take_widgets();
  const char* screen = m_film      ? "film"
                       : m_display ? "display"
                       : m_views   ? "views"
                       : m_help    ? "help"
                       : m_menu    ? "menu"
                                   : "player";
  if (!m_log.on() || (widgets == m_widgets && m_screen == screen)) return;
  m_widgets = widgets;
  m_screen = screen;
  Json places = Json::object();
  for (const ui::Widget& w : widgets) places[w.id] = {w.x, w.y};
  const auto place = [](const Area& a) { return Json{a.x, a.y, a.width, a.height}; };
  m_log.event("screen", {{"name", screen},
                         {"widgets", places},
                         {"large", place(m_panes.first().area)},
                         {"small", place(m_panes.panes().size() > 1 ? m_panes.panes()[1].area : Area{})},
                         {"bar", place(m_bar)}});
}

void Player::log_shown(const sim::State& state) {
  const bool told = m_logged_tick == now() && m_logged_exact == m_exact && m_logged_playing == m_playing;
  if (!m_log.on() || told) return;
  const double took = std::chrono::duration<double, std::milli>(Clock::now() - m_asked_at).count();
  Json details{{"tick", now()}, {"state_tick", state.tick}, {"exact", m_exact}, {"playing", m_playing}, {"ms", took}};
  if (m_exact && !m_playing) details["hash"] = core::hex(sim::hash_of(state));
  if (m_logged_tick == attempt::Reel::kNowhere) details["last"] = m_line.last();
  m_log.event("shown", details);
  m_logged_tick = now();
  m_logged_exact = m_exact;
  m_logged_playing = m_playing;
}

void Player::log_camera() {
  const PaneCameras& cameras = m_panes.cameras;
  Json panes = Json::array();
  for (int i = 0; i < m_layout.count(); ++i) panes.push_back(name_of(m_layout.panes[std::size_t(i)]));
  m_log.event("camera", {{"endoscope", endoscope()},
                         {"inset", m_layout.layout != Layout::one},
                         {"layout", name_of(m_layout.layout)},
                         {"panes", panes},
                         {"yaw", cameras.outside.yaw},
                         {"pitch", cameras.outside.pitch},
                         {"distance", cameras.outside.distance},
                         {"second_yaw", cameras.second.pose.yaw}});
}

}  // namespace trocar::app
