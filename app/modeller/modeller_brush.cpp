// Painting on the chosen body: what holds it, where its bonds are, how stiff it is there.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include <trocar/core/text.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/modeller/picture/painted.hpp>
#include <trocar/scene/json/json_text.hpp>
#include <trocar/sim/model/bodies.hpp>

#include "modeller/modeller_parts.hpp"

namespace trocar::app {
namespace {

constexpr float kDot = 4.5f;  // [px] of a painted place

/// Blue where it is softer, orange where it is stiffer or held; clear where nothing was painted.
ImU32 colour_of_paint(double value, bool stiffness) {
  if (!stiffness) return value > 0 ? IM_COL32(242, 168, 26, 220) : 0;
  const double decades = std::clamp(std::log10(value), -1.0, 1.0);
  if (std::fabs(decades) < 0.01) return 0;
  const int strength = 90 + int(150 * std::fabs(decades));
  return decades > 0 ? IM_COL32(242, 130, 26, strength) : IM_COL32(80, 170, 250, strength);
}

}  // namespace

void Modeller::toggle_brush() {
  if (m_brush.on) {
    m_brush = {};
    return tell("");
  }
  const std::optional<modeller::Thing> thing = selected();
  if (!thing || (thing->kind != "solid" && thing->kind != "pouch")) return warn(tr("Choose an organ to paint on."));
  m_brush.on = true;
  tell(tr("Drag over the body to paint. Shift: erase. Ctrl-wheel: brush width. B or Esc: end."));
}

/// The chosen body's place under the pointer.
std::optional<Vec3d> Modeller::on_chosen(const Viewport& v, float x, float y) const {
  const std::optional<modeller::Thing> thing = selected();
  if (!m_shown || !thing) return std::nullopt;
  const std::optional<modeller::BodyPlace> met = modeller::met_by(m_places, v.eye(), v.ray(x, y), kRayReach);
  if (!met || sim::name_of(*m_shown->built.model, met->body) != thing->name) return std::nullopt;
  return met->at;
}

void Modeller::brush_in(Viewport& v) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.KeyCtrl && io.MouseWheel != 0)
    m_brush.radius_mm = std::clamp(m_brush.radius_mm * std::exp(0.12 * io.MouseWheel), 0.5, 200.0);
  if (io.MouseClicked[0]) m_brush.stroke.clear(), m_brush.erases = io.KeyShift;
  if (io.MouseDown[0])
    if (const std::optional<Vec3d> at = on_chosen(v, io.MousePos.x, io.MousePos.y)) {
      const double apart = 0.5e-3 * m_brush.radius_mm;
      if (m_brush.stroke.empty() || length(*at - m_brush.stroke.back()) >= apart) m_brush.stroke.push_back(*at);
    }
  if (io.MouseReleased[0] && !m_brush.stroke.empty()) end_stroke();
}

void Modeller::end_stroke() {
  std::vector<Vec3d> places;
  for (const Vec3d& p : std::exchange(m_brush.stroke, {})) places.push_back(p * 1e3);
  scene::JsonValue s = scene::json_object();
  scene::put(s, "do", scene::json_text("paint"));
  scene::put(s, "of", scene::json_text(m_selected));
  scene::put(s, "what", scene::json_text(m_brush.what));
  scene::put(s, "places_mm", modeller::points(places));
  scene::put(s, "radius_mm", modeller::number(m_brush.radius_mm));
  if (m_brush.what == "stiffness") scene::put(s, "stiffness", modeller::number(m_brush.stiffness));
  if (m_brush.erases) scene::put(s, "erase", scene::json_flag(true));
  if (step(std::move(s))) tell(m_brush.erases ? tr("Erased.") : tr("Painted."));
}

void Modeller::draw_brush_over(const Viewport& v) const {
  const std::optional<modeller::Thing> thing = selected();
  if (!m_brush.on || !m_shown || !thing) return;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const modeller::Painted painted = modeller::painted_on(*m_document, m_selected, m_brush.what);
  Vec3d middle{0, 0, 0};
  std::vector<Vec3d> skin;
  for (const modeller::BodyPlace& p : m_places)
    if (sim::name_of(*m_shown->built.model, p.body) == thing->name) skin.push_back(p.at), middle += p.at;
  middle = middle / std::max<double>(1, double(skin.size()));
  for (const Vec3d& p : skin) {
    if (dot(p - middle, v.eye() - p) < 0) continue;  // about: what is behind shows nothing
    const ImU32 colour = colour_of_paint(painted.at(p), painted.stiffness);
    if (const std::optional<modeller::Spot> s = colour ? v.spot(p) : std::nullopt)
      list.AddCircleFilled({s->x, s->y}, kDot, colour, 8);
  }
  const ImGuiIO& io = ImGui::GetIO();
  const auto ring = [&](Vec3d at, ImU32 colour) {
    if (const std::optional<modeller::Spot> s = v.spot(at))
      list.AddCircle({s->x, s->y}, float(1e-3 * m_brush.radius_mm / v.pixel(at)), colour, 40, 1.5f);
  };
  for (const Vec3d& p : m_brush.stroke) ring(p, IM_COL32(242, 168, 26, 130));
  if (!v.area.holds(io.MousePos.x, io.MousePos.y)) return;
  if (const std::optional<Vec3d> at = on_chosen(v, io.MousePos.x, io.MousePos.y))
    ring(*at, io.KeyShift ? IM_COL32(230, 230, 230, 255) : IM_COL32(242, 168, 26, 255));
}

void Modeller::draw_brush_panel() {
  if (!m_brush.on) return;
  ImGui::SetNextWindowPos({m_middle.x + 12, m_middle.y + 12});
  ImGui::SetNextWindowSize({300 * ui::scale(), 0});
  ImGui::Begin("brush", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_AlwaysAutoResize);
  const std::optional<modeller::Thing> thing = selected();
  ui::text(tr("Paint on {}", thing ? thing->name : std::string("?")));
  static constexpr std::pair<const char*, const char*> kWhat[] = {
      {"hold", "attachment"}, {"stiffness", "stiffness"}, {"bonds", "bonds"}};
  for (const auto& [what, label] : kWhat) {
    if (m_brush.what == what) ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(0.10f, 0.40f, 0.58f, 1));
    const bool chosen = m_brush.what == what, pressed = ImGui::SmallButton(tr(label));
    if (chosen) ImGui::PopStyleColor();
    ui::note_widget(std::string("paint ") + what);
    if (pressed) m_brush.what = what;
    ImGui::SameLine();
  }
  ImGui::NewLine();
  float radius = float(m_brush.radius_mm), stiffness = float(m_brush.stiffness);
  ImGui::SetNextItemWidth(-1);
  if (ImGui::SliderFloat("##wide", &radius, 0.5f, 60, tr("brush radius %.1f mm"), ImGuiSliderFlags_Logarithmic))
    m_brush.radius_mm = double(radius);
  ImGui::SetNextItemWidth(-1);
  if (m_brush.what == "stiffness" &&
      ImGui::SliderFloat("##stiff", &stiffness, 0.1f, 10, tr("%.2f times as stiff"), ImGuiSliderFlags_Logarithmic))
    m_brush.stiffness = double(stiffness);
  ui::text(tr("Shift: erase. B or Esc: end."), ui::kGrey);
  ImGui::End();
}

}  // namespace trocar::app
