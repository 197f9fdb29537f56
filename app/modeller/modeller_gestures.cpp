// Moving, turning and scaling what is selected, with the pointer or by typed numbers.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include <trocar/core/text.hpp>
#include <trocar/modeller/operations/points.hpp>
#include <trocar/modeller/operations/transform.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/json/json_text.hpp>
#include <trocar/sim/model/bodies.hpp>

#include "modeller/modeller_parts.hpp"

namespace trocar::app {
namespace {

constexpr double kDegree = portable::pi / 180;
constexpr Vec3d kAxes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

double snapped(double value, double to, bool snap) { return snap ? std::round(value / to) * to : value; }

}  // namespace

/// Where the pointer meets a body that is not the one being moved.
std::optional<Vec3d> Modeller::onto_other_body(const Viewport& v, float x, float y) const {
  const std::optional<modeller::Thing> own = selected();
  if (!m_shown || !own) return std::nullopt;
  std::vector<modeller::BodyPlace> others;
  for (const modeller::BodyPlace& p : m_places)
    if (sim::name_of(*m_shown->built.model, p.body) != own->name) others.push_back(p);
  const std::optional<modeller::BodyPlace> met = modeller::met_by(others, v.eye(), v.ray(x, y), kRayReach);
  return met ? std::optional(met->at) : std::nullopt;
}

void Modeller::begin_gesture(Gesture::Kind kind) {
  const std::optional<modeller::Thing> thing = selected();
  if (!thing) return warn(tr("Choose a body first."));
  const ImGuiIO& io = ImGui::GetIO();
  Gesture g;
  g.kind = kind;
  g.thing = m_selected;
  g.from_x = io.MousePos.x;
  g.from_y = io.MousePos.y;
  g.about = modeller::middle_of(modeller::value_of(*m_document, *thing)) * 1e-3;
  if (m_handle && kind == Gesture::Kind::move) {
    g.list = m_handle->list;
    g.item = m_handle->item;
    g.about = m_handle->at;
  }
  m_gesture = g;
  m_previewed = false;
}

void Modeller::begin_drag(const modeller::Handle& handle, float x, float y) {
  m_handle = handle;
  Gesture g;
  g.thing = m_selected;
  g.list = handle.list;
  g.item = handle.item;
  g.about = handle.at;
  g.from_x = x;
  g.from_y = y;
  g.dragged = true;
  m_gesture = g;
  m_previewed = false;
}

/// A part of the gizmo was taken: as the key and the axis would do, as long as the button is held.
void Modeller::begin_gizmo(const GizmoPart& part, float x, float y) {
  begin_gesture(part.kind);
  m_gesture->axis = part.axis;
  m_gesture->from_x = x;
  m_gesture->from_y = y;
  m_gesture->dragged = true;
}

/// The step of a script that the gesture comes to now; none: nothing has moved.
std::optional<scene::JsonValue> Modeller::step_of_gesture(std::string& amount) const {
  const Gesture& g = *m_gesture;
  const ImGuiIO& io = ImGui::GetIO();
  const Viewport& v = m_views[std::size_t(m_active)];
  const float x = io.MousePos.x, y = io.MousePos.y;
  const bool snap = io.KeyCtrl;
  const double fine = io.KeyShift ? 0.1 : 1;
  scene::JsonValue s = scene::json_object();
  const scene::JsonValue of = scene::json_array({scene::json_text(g.thing)});
  if (g.kind == Gesture::Kind::move) {
    Vec3d by = (v.on_plane_of(g.about, x, y) - v.on_plane_of(g.about, g.from_x, g.from_y)) * (1e3 * fine);
    if (const std::optional<Vec3d> there = m_snap ? onto_other_body(v, x, y) : std::nullopt)
      by = (*there - g.about) * 1e3;
    else if (g.axis >= 0)
      by = kAxes[g.axis] *
           (1e3 * fine * (v.along(g.about, kAxes[g.axis], x, y) - v.along(g.about, kAxes[g.axis], g.from_x, g.from_y)));
    if (g.axis >= 0) by = kAxes[g.axis] * dot(by, kAxes[g.axis]);
    if (const std::optional<double> n = g.number()) by = kAxes[g.axis < 0 ? 0 : g.axis] * *n;
    by = {snapped(by.x, 1, snap), snapped(by.y, 1, snap), snapped(by.z, 1, snap)};
    amount = tr("({:.1f}, {:.1f}, {:.1f}) mm", by.x, by.y, by.z);
    if (length(by) < 1e-4) return std::nullopt;
    scene::put(s, "do", scene::json_text(g.item ? "move_point" : "move"));
    scene::put(s, "of", g.item ? scene::json_text(g.thing) : of);
    if (g.item) {
      scene::put(s, "key", scene::json_text(g.list.substr(1)));
      scene::put(s, "item", scene::json_number(double(*g.item)));
    }
    scene::put(s, "by_mm", modeller::point(by));
    if (g.item && m_soft) scene::put(s, "soft_mm", modeller::number(m_soft_mm));
    if (g.item && m_symmetric) scene::put(s, "symmetric", scene::json_flag(true));
    return s;
  }
  const std::optional<modeller::Spot> middle = v.spot(g.about);
  if (!middle) return std::nullopt;
  if (g.kind == Gesture::Kind::rotate) {
    const double from = std::atan2(g.from_y - middle->y, g.from_x - middle->x),
                 to = std::atan2(y - middle->y, x - middle->x);
    double by = std::remainder(from - to, 2 * portable::pi) / kDegree * fine;
    Vec3d axis = v.eye() - g.about;  // towards the viewer, so that it turns as the pointer does
    axis = axis / length(axis);
    if (g.axis >= 0) {
      if (dot(axis, kAxes[g.axis]) < 0) by = -by;
      axis = kAxes[g.axis];
    }
    if (const std::optional<double> n = g.number()) by = *n;
    by = snapped(by, 5, snap);
    amount = tr("{:.1f} degrees", by);
    if (std::fabs(by) < 1e-3) return std::nullopt;
    scene::put(s, "do", scene::json_text("rotate"));
    scene::put(s, "of", of);
    scene::put(s, "axis", modeller::point(axis));
    scene::put(s, "by_deg", modeller::number(by));
    return s;
  }
  const double from = std::hypot(g.from_x - middle->x, g.from_y - middle->y),
               to = std::hypot(x - middle->x, y - middle->y);
  double by = std::clamp(1 + fine * (to / std::max(from, 5.0) - 1), 0.05, 20.0);
  if (const std::optional<double> n = g.number()) by = std::clamp(*n, 0.01, 100.0);
  by = snapped(by, 0.1, snap);
  amount = fmt::format("{:.3f}", by);
  if (std::fabs(by - 1) < 1e-4 || by <= 0) return std::nullopt;
  scene::put(s, "do", scene::json_text(g.axis < 0 ? "scale" : "stretch"));
  scene::put(s, "of", of);
  if (g.axis < 0)
    scene::put(s, "by", modeller::number(by));
  else
    scene::put(s, "by", modeller::point(Vec3d{1, 1, 1} + kAxes[g.axis] * (by - 1)));
  return s;
}

/// The document shows what it comes to, as a change that gives way to the next one until it is kept.
void Modeller::preview_gesture() {
  std::string amount;
  const std::optional<scene::JsonValue> wanted = step_of_gesture(amount);
  if (m_previewed) m_document->undo();
  m_previewed = false;
  if (wanted) {
    const std::size_t before = m_document->done();
    step(*wanted);
    m_previewed = m_document->done() > before;
  }
  tell(m_gesture->said(amount));
}

void Modeller::lead_gesture() {
  const ImGuiIO& io = ImGui::GetIO();
  if (m_soft && io.MouseWheel != 0) m_soft_mm = std::clamp(m_soft_mm * std::exp(0.15 * io.MouseWheel), 1.0, 500.0);
  preview_gesture();
  if (m_gesture->dragged ? !io.MouseDown[0] : io.MouseClicked[0]) return end_gesture(true);
  if (io.MouseClicked[1]) end_gesture(false);
}

void Modeller::end_gesture(bool keep) {
  if (!keep && m_previewed) m_document->undo();
  const bool changed = keep && m_previewed;
  m_log.event("gesture", {{"kept", changed}, {"done", m_document->done()}});
  m_previewed = false;
  m_gesture.reset();
  tell(changed ? m_document->history()[m_document->done() - 1].name : "");
  if (m_handle && changed)
    for (const modeller::Handle& h : modeller::handles_of(*m_document, m_selected).points)
      if (h.list == m_handle->list && h.item == m_handle->item) m_handle = h;
  ++m_picture;
}

}  // namespace trocar::app
