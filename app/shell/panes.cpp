#include "shell/panes.hpp"

#include <algorithm>
#include <cmath>

#include <imgui.h>

#include <trocar/pictures/camera_choice.hpp>
#include <trocar/pictures/legend_drawing.hpp>

namespace trocar::app {
namespace {

constexpr double kTurnPerPixel = 0.006;  // [rad]
constexpr double kAimPerPixel = 0.002;   // [rad]
constexpr double kZoomPerNotch = 0.12;
constexpr double kScopePerZoom = 0.05;  // [m] that the second scope goes in where others come closer by e

bool is_scope(PaneShows shows) { return shows == PaneShows::endoscope || shows == PaneShows::second_scope; }

const char* label_of(PaneShows shows) {
  switch (shows) {
    case PaneShows::endoscope:
      return "endoscope";
    case PaneShows::second_scope:
      return "second endoscope";
    case PaneShows::outside:
      return "from outside";
    case PaneShows::analysis:
      break;
  }
  return "analysis";
}

}  // namespace

render::Target window_target(const Area& a, int window_height) {
  render::Target t = render::Target::window(std::max(1, int(a.width)), std::max(1, int(a.height)));
  t.x = int(a.x);
  t.y = window_height - int(a.y) - int(a.height);
  return t;
}

void fit_to(const Area& area, render::Frame& frame) {
  const float share = area.width / area.height;
  if (!(share > 0) || share >= 1) return;
  frame.camera.vertical_fov = 2 * std::atan(std::tan(frame.camera.vertical_fov / 2) / share);
  frame.look.mask_diameter *= share;
}

Panes::Panes(const sim::Model& model) {
  cameras.outside = cameras.analysis_orbit =
      pictures::orbit_of(pictures::choice_of(pictures::kCameraPresets[0]), view::orbit_around(model));
  cameras.second = view::second_scope_of(model);
  cameras.analysis.strain = cameras.analysis.forces = true;
}

void Panes::lay_out(const LayoutChoice& choice, const Area& whole, float scale, pictures::PictureSize elsewhere) {
  std::vector<Area> areas = areas_of(choice.layout, whole, scale);
  m_panes.clear();
  for (std::size_t i = 0; i < areas.size(); ++i) m_panes.push_back({choice.panes[i], areas[i]});
  if (choice.elsewhere && elsewhere.width > 0 && choice.panes[0] != *choice.elsewhere) {
    areas.push_back({0, 0, float(elsewhere.width), float(elsewhere.height)});
    m_panes.push_back({*choice.elsewhere, areas.back(), true});
  }
  m_load = load_of(areas, whole);
  m_drawn.resize(m_panes.size());
  while (m_canvas.size() < m_panes.size()) m_canvas.emplace_back();
  m_scale = scale;
}

const PaneCanvas* Panes::canvas_elsewhere() const {
  for (std::size_t i = 1; i < m_panes.size(); ++i)
    if (m_panes[i].elsewhere) return &m_canvas[i];
  return nullptr;
}

view::Legend Panes::legend_of_pane(PaneShows shows) const {
  return shows == PaneShows::analysis ? legend_of(cameras.analysis) : view::Legend{};
}

view::ViewOptions Panes::options(PaneShows shows) const {
  view::ViewOptions o;
  switch (shows) {
    case PaneShows::endoscope:
      o.eye_index = kEndoscopeEye;
      return o;
    case PaneShows::second_scope:
      o = view_through(cameras.second);
      o.eye_index = kSecondScopeEye;
      return o;
    case PaneShows::outside:
      o = pictures::view_of(cameras.outside);
      break;
    case PaneShows::analysis:
      if (!cameras.analysis_from_endoscope) o = pictures::view_of(cameras.analysis_orbit), o.walls = false;
      o.analysis = cameras.analysis;
      o.beside = beside;
      break;
  }
  o.eye_index = kOutsideEye;
  if (std::any_of(m_panes.begin(), m_panes.end(), [](const Pane& p) { return p.shows == PaneShows::second_scope; }))
    o.second_scope = cameras.second;
  return o;
}

bool Panes::turn(PaneShows shows, double yaw, double pitch) {
  if (shows == PaneShows::second_scope) {
    aim(cameras.second, yaw * kAimPerPixel / kTurnPerPixel, pitch * kAimPerPixel / kTurnPerPixel);
    return true;
  }
  if (shows == PaneShows::endoscope || (shows == PaneShows::analysis && cameras.analysis_from_endoscope)) return false;
  (shows == PaneShows::outside ? cameras.outside : cameras.analysis_orbit).turn(yaw, pitch);
  return true;
}

bool Panes::shift(PaneShows shows, double right, double up) {
  if (is_scope(shows) || (shows == PaneShows::analysis && cameras.analysis_from_endoscope)) return false;
  view::Orbit& orbit = shows == PaneShows::outside ? cameras.outside : cameras.analysis_orbit;
  orbit.pan(right * orbit.distance, up * orbit.distance);
  return true;
}

bool Panes::closer(PaneShows shows, double by) {
  if (shows == PaneShows::second_scope) {
    advance(cameras.second, kScopePerZoom * by);
    return true;
  }
  if (shows == PaneShows::endoscope || (shows == PaneShows::analysis && cameras.analysis_from_endoscope)) return false;
  (shows == PaneShows::outside ? cameras.outside : cameras.analysis_orbit).zoom(std::exp(-by));
  return true;
}

const Panes::Pane* Panes::under_pointer() const {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantCaptureMouse) return nullptr;
  const Pane* over = nullptr;  // the last one lies on top
  for (const Pane& pane : m_panes)
    if (!pane.elsewhere && pane.area.holds(io.MousePos.x, io.MousePos.y)) over = &pane;
  return over;
}

bool Panes::listen() {
  const ImGuiIO& io = ImGui::GetIO();
  if (!io.MouseDown[0] && !io.MouseDown[1] && !io.MouseDown[2]) m_dragged = -1;
  const Pane* under = under_pointer();
  const int over = under ? int(under - m_panes.data()) : -1;
  if (over >= 0 && (io.MouseClicked[0] || io.MouseClicked[1] || io.MouseClicked[2])) {
    m_dragged = over;
    m_shifting = io.KeyShift || !io.MouseClicked[0];
  }
  bool moved = false;
  if (over >= 0 && io.MouseWheel != 0)
    moved |= closer(m_panes[std::size_t(over)].shows, kZoomPerNotch * double(io.MouseWheel));
  if (m_dragged < 0 || m_dragged >= int(m_panes.size())) return moved;
  const Pane& pane = m_panes[std::size_t(m_dragged)];
  const double dx = double(io.MouseDelta.x), dy = double(io.MouseDelta.y);
  if (dx == 0 && dy == 0) return moved;
  if (m_shifting)
    return shift(pane.shows, -0.75 * dx / double(pane.area.height), 0.75 * dy / double(pane.area.height)) || moved;
  return turn(pane.shows, -kTurnPerPixel * dx, kTurnPerPixel * dy) || moved;
}

void Panes::draw_one(const Source& source, std::size_t i) {
  const Pane& pane = m_panes[i];
  view::ViewOptions o = options(pane.shows);
  o.quality = source.quality;
  o.styles = source.styles;
  o.picture_height = double(pane.area.height);
  render::Frame frame = source.view.frame(source.state, o);
  frame.tick = source.clock;
  fit_to(pane.area, frame);
  render::draw_frame(source.backend, frame,
                     m_canvas[i].target(std::max(1, int(pane.area.width)), std::max(1, int(pane.area.height))));
  m_drawn[i] = pane;
}

void Panes::draw_others(const Source& source, bool all) {
  const std::size_t others = m_panes.size() - 1;
  if (others == 0) return;
  m_turn = (m_turn + 1) % others;
  for (std::size_t i = 1; i <= others; ++i)
    if (all || i == m_turn + 1 || !(m_drawn[i] == m_panes[i])) draw_one(source, i);
}

void Panes::lay_others(int window_height, bool mirrored) const {
  for (std::size_t i = 1; i < m_panes.size(); ++i)
    if (!m_panes[i].elsewhere)
      m_canvas[i].lay(window_target(m_panes[i].area, window_height), mirrored && is_scope(m_panes[i].shows));
}

void Panes::write_over(bool names) const {
  ImDrawList& over = *ImGui::GetBackgroundDrawList();
  const float margin = 8 * m_scale;
  for (std::size_t i = 0; i < m_panes.size(); ++i) {
    const Area& a = m_panes[i].area;
    if (m_panes[i].elsewhere) continue;
    const float right = a.x + a.width, bottom = a.y + a.height;
    if (i > 0) over.AddRect({a.x, a.y}, {right, bottom}, IM_COL32(200, 205, 212, 255), 0, 0, 1.5f * m_scale);
    over.PushClipRect({a.x, a.y}, {right, bottom}, true);
    if (names)
      over.AddText({a.x + margin, a.y + 6 * m_scale}, IM_COL32(235, 235, 235, 220), label_of(m_panes[i].shows));
    if (m_panes[i].shows == PaneShows::analysis && cameras.analysis.on())
      pictures::draw_legend(legend_of_pane(m_panes[i].shows), over, a.x + margin, bottom - margin, 0.45f * a.width);
    over.PopClipRect();
  }
}

}  // namespace trocar::app
