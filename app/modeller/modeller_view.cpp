// Views of the document, and the pointer over them.
#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include <trocar/core/text.hpp>
#include <trocar/modeller/operations/transform.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/json/json_text.hpp>
#include <trocar/sim/model/bodies.hpp>

#include "modeller/modeller_parts.hpp"
#include "shell/panes.hpp"

namespace trocar::app {
namespace {

constexpr float kHandleReach = 12;           // [px] of a handle
constexpr float kViewTurn = 0.008f;          // [rad/px]
constexpr std::uint64_t kPictureStep = 500;  // [ms] of a camera's time that a picture takes

const ImU32 kLineColour = IM_COL32(107, 191, 242, 200), kPointColour = IM_COL32(242, 168, 26, 255),
            kTakenColour = IM_COL32(255, 255, 255, 255), kRimColour = IM_COL32(20, 22, 26, 255);

}  // namespace

/// Operations for which one click says where.
bool Modeller::is_one_place(const std::string& operation) {
  return operation == "port" || operation == "mark" || operation == "tool" || operation == "scope";
}

void Modeller::draw_view(Viewport& v) {
  if (!m_view || v.area.width < 2) return;
  view::ViewOptions options = modeller::seen_from(v.orbit);
  options.picture_height = double(v.area.height);
  const bool moving = m_drive || m_gesture || ImGui::IsAnyMouseDown();
  options.quality = moving ? m_governor.quality() : render::Quality{};
  options.eye_index = int(&v - m_views.data());
  options.instruments = m_instruments || m_drive;
  if (!m_hidden.empty())
    for (const view::ScenePart& part : m_view->parts())
      options.styles.push_back(m_hidden.count(part.name) ? view::PartStyle::hidden : view::PartStyle::shaded);
  render::Frame frame = m_view->frame(*m_state, options);
  frame.tick = m_picture * kPictureStep;
  v.camera = frame.camera;
  render::draw_frame(*m_backend, frame, v.canvas.target(int(v.area.width), int(v.area.height)));
}

void Modeller::draw_views() {
  const auto begin = std::chrono::steady_clock::now();
  bool drew = false;
  for (Viewport& v : m_views) {
    if (v.area.width < 2 || !m_view) continue;
    const std::uint64_t wanted = m_picture * 1000 + std::uint64_t(v.area.width);
    if (v.drawn != wanted) {
      draw_view(v);
      v.drawn = wanted;
      drew = true;
    }
    v.canvas.lay(window_target(v.area, m_window.height()));
  }
  if (drew) m_governor.frame_took(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  if (!m_selected.empty() && (m_handles_of != m_document->version() || m_handles_thing != m_selected)) {
    m_handles = selected() ? modeller::handles_of(*m_document, m_selected) : modeller::Handles{};
    m_handles_of = m_document->version();
    m_handles_thing = m_selected;
  }
  if (m_selected.empty()) m_handles = {};
  place_gizmo();
}

/// Where arrows and rings stand: at the point that was taken, which moves only, else in the chosen thing's middle.
void Modeller::place_gizmo() {
  m_gizmo = {};
  if (m_handles.points.empty() || m_drive || m_brush.on || m_measuring || !m_draw_for.empty()) return;
  if (m_handle) {
    for (const modeller::Handle& h : m_handles.points)
      if (h.list == m_handle->list && h.item == m_handle->item) m_gizmo = {h.at, true, false};
  } else if (const std::optional<modeller::Thing> thing = selected()) {
    m_gizmo = {modeller::middle_of(modeller::value_of(*m_document, *thing)) * 1e-3, true, true};
  }
}

void Modeller::draw_points(const Viewport& v, ImDrawList& list) const {
  for (const modeller::HandleLine& line : m_handles.lines)
    for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
      const std::optional<modeller::Spot> a = v.spot(line.points[i]), b = v.spot(line.points[i + 1]);
      if (a && b) list.AddLine({a->x, a->y}, {b->x, b->y}, kLineColour, 1.3f);
    }
  for (const modeller::Handle& h : m_handles.points) {
    const std::optional<modeller::Spot> s = v.spot(h.at);
    if (!s) continue;
    const bool taken = m_handle && m_handle->list == h.list && m_handle->item == h.item;
    list.AddCircleFilled({s->x, s->y}, taken ? 7.0f : 5.5f, kRimColour);
    list.AddCircleFilled({s->x, s->y}, taken ? 5.5f : 4.0f, taken ? kTakenColour : kPointColour);
  }
}

void Modeller::draw_handles(const Viewport& v) const {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.PushClipRect({v.area.x, v.area.y}, {v.area.x + v.area.width, v.area.y + v.area.height});
  if (!m_brush.on) draw_points(v, list);
  draw_gizmo(m_gizmo, v, pointed_part(v), list);
  if (m_soft && m_handle) {
    const std::optional<modeller::Spot> s = v.spot(m_handle->at);
    if (s) list.AddCircle({s->x, s->y}, float(m_soft_mm * 1e-3 / v.pixel(m_handle->at)), kPointColour, 48, 1.2f);
  }
  for (std::size_t i = 0; i < m_measured.size(); ++i) {
    const std::optional<modeller::Spot> s = v.spot(m_measured[i]);
    if (!s) continue;
    list.AddCircleFilled({s->x, s->y}, 4, IM_COL32(240, 240, 240, 255));
    if (i == 0) continue;
    const std::optional<modeller::Spot> before = v.spot(m_measured[i - 1]);
    if (!before) continue;
    list.AddLine({before->x, before->y}, {s->x, s->y}, IM_COL32(240, 240, 240, 255), 1.5f);
    const std::string text = tr("{:.1f} mm", 1e3 * length(m_measured[i] - m_measured[i - 1]));
    list.AddText({(before->x + s->x) / 2 + 6, (before->y + s->y) / 2 - 18}, IM_COL32(255, 255, 255, 255), text.c_str());
  }
  for (std::size_t i = 0; i < m_drawn.size(); ++i) {
    const std::optional<modeller::Spot> s = v.spot(m_drawn[i]);
    if (!s) continue;
    list.AddCircleFilled({s->x, s->y}, 4.5f, kPointColour);
    if (i == 0) continue;
    if (const std::optional<modeller::Spot> before = v.spot(m_drawn[i - 1]))
      list.AddLine({before->x, before->y}, {s->x, s->y}, kPointColour, 2);
  }
  // which way the patient's axes point
  const Vec3d ends[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const ImU32 colours[3] = {IM_COL32(230, 120, 60, 255), IM_COL32(90, 180, 230, 255), IM_COL32(220, 220, 120, 255)};
  const char* words[3] = {tr("left"), tr("head"), tr("front")};
  const float x = v.area.x + 46, y = v.area.y + v.area.height - 46;
  for (int i = 0; i < 3; ++i) {
    const Vec3f d{float(ends[i].x), float(ends[i].y), float(ends[i].z)};
    const float dx = 30 * dot(v.camera.rotation.column(0), d), dy = -30 * dot(v.camera.rotation.column(1), d);
    list.AddLine({x, y}, {x + dx, y + dy}, colours[i], 2);
    list.AddText({x + 1.25f * dx - 8, y + 1.25f * dy - 8}, colours[i], words[i]);
  }
  draw_brush_over(v);
  if (m_four) list.AddText({v.area.x + 8, v.area.y + 6}, IM_COL32(200, 205, 210, 255), tr(v.name.c_str()));
  list.PopClipRect();
}

void Modeller::draw_over_views() {
  for (const Viewport& v : m_views)
    if (v.area.width >= 2) draw_handles(v);
  if (m_view) return;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const char* text =
      m_builder.busy() ? tr("Compiling ...") : tr("Nothing to show yet. Add an organ (Add), or import one (File).");
  list.AddText({m_middle.x + 24, m_middle.y + 24}, IM_COL32(190, 195, 200, 255), text);
}

/// The part of the gizmo that is led, or that a press would take.
std::optional<GizmoPart> Modeller::pointed_part(const Viewport& v) const {
  if (m_gesture) return m_gesture->axis < 0 ? std::nullopt : std::optional(GizmoPart{m_gesture->kind, m_gesture->axis});
  const ImGuiIO& io = ImGui::GetIO();
  return v.area.holds(io.MousePos.x, io.MousePos.y) ? gizmo_at(m_gizmo, v, io.MousePos.x, io.MousePos.y) : std::nullopt;
}

Viewport* Modeller::view_under(float x, float y) {
  for (Viewport& v : m_views)
    if (v.area.width >= 2 && v.area.holds(x, y)) return &v;
  return nullptr;
}

void Modeller::point() {
  const ImGuiIO& io = ImGui::GetIO();
  if (m_gesture) {
    lead_gesture();
    return;
  }
  if (io.WantCaptureMouse && !m_taking) return;
  if (Viewport* v = view_under(io.MousePos.x, io.MousePos.y)) point_in(*v);
  if (m_taking && !io.MouseDown[0]) {
    m_taking = false;
    m_drive->let_go();
  }
}

void Modeller::point_in(Viewport& v) {
  const ImGuiIO& io = ImGui::GetIO();
  const float x = io.MousePos.x, y = io.MousePos.y;
  if (io.MouseClicked[0] || io.MouseClicked[1] || io.MouseClicked[2]) m_active = int(&v - m_views.data());
  const bool pans = io.MouseDown[2] || (io.MouseDown[1] && io.KeyShift);
  if (pans || io.MouseDown[1]) {
    if (pans)
      v.orbit.pan(-io.MouseDelta.x * v.pixel(v.orbit.target), io.MouseDelta.y * v.pixel(v.orbit.target));
    else
      v.orbit.turn(-io.MouseDelta.x * kViewTurn, io.MouseDelta.y * kViewTurn);
    if (io.MouseDelta.x != 0 || io.MouseDelta.y != 0) ++m_picture;
  }
  if (io.MouseWheel != 0 && !(m_brush.on && io.KeyCtrl)) v.orbit.zoom(std::exp(-0.12 * io.MouseWheel)), ++m_picture;
  if (io.MouseReleased[1] || io.MouseReleased[2]) ++m_picture;  // once more, at full quality
  if (m_drive) {
    if (io.MouseClicked[0] && m_drive->hand() >= 0) {
      m_places = modeller::places_of(*m_shown->built.model, *m_state);
      if (const std::optional<modeller::BodyPlace> met = modeller::met_by(m_places, v.eye(), v.ray(x, y), kRayReach)) {
        m_drive->take(met->at);
        m_taking = true;
        tell(tr("Grasping {}", sim::name_of(*m_shown->built.model, met->body)));
      }
    }
    if (m_taking && m_drive->holds() && m_drive->done()) m_drive->pull_to(v.on_plane_of(m_drive->tip(), x, y));
    if (m_taking && m_drive->holds()) {
      m_drive->pull_to(v.on_plane_of(m_drive->tip(), x, y));
      tell(tr("Pull {:.2f} N", m_drive->pull()));
    }
    return;
  }
  if (m_brush.on) return brush_in(v);
  if (!io.MouseClicked[0]) return;
  if (!m_draw_for.empty()) return draw_point(v, x, y);
  if (m_measuring) {
    if (const std::optional<modeller::BodyPlace> met = modeller::met_by(m_places, v.eye(), v.ray(x, y), kRayReach))
      m_measured.push_back(met->at);
    return;
  }
  const std::optional<std::size_t> handle =
      modeller::handle_at(m_handles, v.camera, int(v.area.width), int(v.area.height), v.local(x, y), kHandleReach);
  if (handle)
    begin_drag(m_handles.points[*handle], x, y);
  else if (const std::optional<GizmoPart> part = gizmo_at(m_gizmo, v, x, y))
    begin_gizmo(*part, x, y);
  else
    pick(v, x, y);
}

/// A point of a line more: on the body that is met there, else as deep as the one before.
void Modeller::draw_point(const Viewport& v, float x, float y) {
  if (ImGui::GetIO().MouseDoubleClicked[0] && m_drawn.size() > 1) return end_drawing(true);
  const std::optional<modeller::BodyPlace> met = modeller::met_by(m_places, v.eye(), v.ray(x, y), kRayReach);
  m_drawn.push_back(met ? met->at : v.on_plane_of(m_drawn.empty() ? v.orbit.target : m_drawn.back(), x, y));
  m_drawn_on = met ? sim::name_of(*m_shown->built.model, met->body) : "";
  if (is_one_place(m_draw_for)) return end_drawing(true);
  tell(tr("{} points. Click: one more. Enter or double click: end. Backspace: one less. Esc: cancel.", m_drawn.size()));
}

/// The line becomes a parameter of its operation, which asks for the others.
void Modeller::end_drawing(bool keep) {
  const std::string operation = std::exchange(m_draw_for, {});
  const std::vector<Vec3d> drawn = std::exchange(m_drawn, {});
  tell("");
  if (!keep || drawn.empty()) return;
  std::string text;
  for (const Vec3d& p : drawn)
    text += fmt::format("{}[{:.1f}, {:.1f}, {:.1f}]", text.empty() ? "" : ", ", 1e3 * p.x, 1e3 * p.y, 1e3 * p.z);
  m_asked.clear();
  m_adding = operation;
  if (is_one_place(operation)) {
    m_asked[operation == "port"   ? "position_mm"
            : operation == "mark" ? "place_mm"
                                  : "tip_mm"] = text.substr(1, text.size() - 2);
    if (operation == "mark") m_asked["on"] = m_drawn_on;
    return;
  }
  const bool vessels = operation == "vessel_tree" || operation == "branch";
  m_asked[vessels ? "path_mm" : "line_mm"] = "[" + text + "]";
}

/// Where the pointer meets the chosen body its nodes are held.
void Modeller::hold_here() {
  const ImGuiIO& io = ImGui::GetIO();
  const Viewport* v = view_under(io.MousePos.x, io.MousePos.y);
  const std::optional<modeller::Thing> thing = selected();
  if (!v || !thing) return warn(tr("Choose a body, then point at the place to attach and press K."));
  const std::optional<modeller::BodyPlace> met =
      modeller::met_by(m_places, v->eye(), v->ray(io.MousePos.x, io.MousePos.y), kRayReach);
  if (!met || sim::name_of(*m_shown->built.model, met->body) != thing->name)
    return warn(tr("Point at the chosen body."));
  scene::JsonValue s = scene::json_object();
  scene::put(s, "do", scene::json_text("hold"));
  scene::put(s, "of", scene::json_text(m_selected));
  scene::put(s, "centre_mm", modeller::point(met->at * 1e3));
  scene::put(s, "radius_mm", modeller::number(std::clamp(m_soft_mm / 2, 2.0, 100.0)));
  if (step(std::move(s))) tell(tr("Attached here."));
}

void Modeller::pick(const Viewport& v, float x, float y) {
  m_handle.reset();
  if (!m_shown) return;
  const std::optional<modeller::BodyPlace> met = modeller::met_by(m_places, v.eye(), v.ray(x, y), kRayReach);
  if (!met) return select("");
  const std::string name = sim::name_of(*m_shown->built.model, met->body);
  for (const modeller::Thing& t : m_things)
    if (t.name == name && t.kind != "tissue" && t.kind != "instrument") return select(t.kind + ":" + t.name);
}

void Modeller::frame_selected() {
  std::vector<Vec3d> places;
  const std::optional<modeller::Thing> thing = selected();
  if (m_shown)
    for (const modeller::BodyPlace& p : m_places)
      if (!thing || sim::name_of(*m_shown->built.model, p.body) == thing->name) places.push_back(p.at);
  if (places.empty())
    for (const modeller::Handle& h : m_handles.points) places.push_back(h.at);
  if (places.empty() && m_shown) {
    for (Viewport& v : m_views) v.orbit = view::orbit_around(*m_shown->built.model);
    ++m_picture;
    return;
  }
  const view::Orbit orbit = modeller::orbit_of(places);
  for (Viewport& v : m_views) v.orbit.target = orbit.target, v.orbit.distance = orbit.distance;
  ++m_picture;
}

/// 0 from before and above, 1 from the feet, 2 from the patient's left, 3 from the front.
void Modeller::look_from(int which) {
  view::Orbit& orbit = m_views[std::size_t(m_active)].orbit;
  constexpr double kDown = 1.52;
  orbit.yaw = which == 2 ? portable::pi / 2 : which == 0 ? 0.35 : 0;
  orbit.pitch = which == 3 ? kDown : which == 0 ? 0.5 : 0;
  ++m_picture;
}

}  // namespace trocar::app
