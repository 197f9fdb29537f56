#include "modeller/chooser.hpp"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>
#include <imgui.h>

#include <trocar/core/text.hpp>
#include <trocar/modeller/document/plain_words.hpp>

#include "shell/ui.hpp"

namespace trocar::app {
namespace {

constexpr float kSwatchWidth = 54, kSwatchHeight = 30;  // [px at scale 1]
constexpr std::uint32_t kDots = 26;

ImU32 packed(Vec3d colour, int alpha = 255) {
  const auto byte = [](double v) { return int(std::clamp(v, 0.0, 255.0)); };
  return IM_COL32(byte(colour.x), byte(colour.y), byte(colour.z), alpha);
}

const modeller::MaterialChoice* material_called(const std::string& name) {
  for (const modeller::MaterialChoice& m : modeller::material_choices())
    if (m.name == name) return &m;
  return nullptr;
}

/// A small picture of a material: its colour with its patches, flecks and a vessel.
void paint_swatch(const modeller::MaterialChoice* m, ImVec2 at, ImVec2 size) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 end{at.x + size.x, at.y + size.y};
  list.AddRectFilled(at, end, m ? packed(m->colour) : IM_COL32(120, 120, 120, 255), 4);
  if (!m) return;
  list.PushClipRect(at, end, true);
  std::uint32_t noise = 2463534242u;  // the same picture every time
  const auto next = [&noise] {
    noise ^= noise << 13, noise ^= noise >> 17, noise ^= noise << 5;
    return float(noise % 1000u) / 1000.0f;
  };
  for (std::uint32_t i = 0; i < kDots; ++i) {
    const ImVec2 spot{at.x + size.x * next(), at.y + size.y * next()};
    const bool patch = i % 3 != 0;
    list.AddCircleFilled(spot, (patch ? 0.16f : 0.05f) * size.y * (0.6f + next()),
                         packed(patch ? m->patches : m->flecks, patch ? 110 : 160), 10);
  }
  list.AddBezierCubic({at.x, at.y + 0.7f * size.y}, {at.x + 0.3f * size.x, at.y + 0.2f * size.y},
                      {at.x + 0.6f * size.x, at.y + 0.9f * size.y}, {end.x, at.y + 0.35f * size.y},
                      packed(m->vessels, 170), std::max(1.0f, 0.05f * size.y));
  list.AddRectFilledMultiColor(at, {end.x, at.y + 0.5f * size.y}, IM_COL32(255, 255, 255, 60),
                               IM_COL32(255, 255, 255, 60), IM_COL32(255, 255, 255, 0), IM_COL32(255, 255, 255, 0));
  list.PopClipRect();
}

/// A row with a picture. True: pressed.
bool picture_row(const std::string& label, const std::string& id, const modeller::MaterialChoice* m, bool is_chosen) {
  const ImVec2 at = ImGui::GetCursorScreenPos(), size{kSwatchWidth * ui::scale(), kSwatchHeight * ui::scale()};
  const bool pressed = ImGui::Selectable(("##" + id).c_str(), is_chosen, 0, {0, size.y + 4});
  ui::note_widget("choose " + id);
  paint_swatch(m, {at.x + 2, at.y + 2}, size);
  ImGui::GetWindowDrawList()->AddText({at.x + size.x + 12, at.y + 0.5f * (size.y - ImGui::GetFontSize()) + 2},
                                      ImGui::GetColorU32(ImGuiCol_Text), label.c_str());
  return pressed;
}

/// Opens a list whose closed form shows a small picture.
bool begin_picture_list(const std::string& id, const std::string& label, const modeller::MaterialChoice* m) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float height = ImGui::GetFrameHeight(), width = 1.6f * height;
  const std::string indented = std::string(std::size_t(width / ImGui::CalcTextSize(" ").x) + 1, ' ') + label;
  constexpr float kList = 380;  // [px at scale 1] wide: names with their stiffness
  ImGui::SetNextWindowSizeConstraints({kList * ui::scale(), 0}, {kList * ui::scale(), 480 * ui::scale()});
  const bool open = ImGui::BeginCombo(id.c_str(), indented.c_str(), ImGuiComboFlags_HeightLarge);
  if (!open) {
    ui::note_widget(id.substr(id.find_first_not_of('#')));
    paint_swatch(m, {at.x + 3, at.y + 3}, {width - 6, height - 6});
  }
  return open;
}

std::string spaced(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

}  // namespace

bool draw_tissue_list(const std::string& id, const std::vector<modeller::TissueChoice>& tissues, std::string& chosen) {
  const auto label = [](const modeller::TissueChoice& t) {
    return fmt::format("{}   ({}, {:.0f} kPa)", spaced(t.name), modeller::stiffness_in_words(t.young), 1e-3 * t.young);
  };
  const auto now = std::find_if(tissues.begin(), tissues.end(), [&](const auto& t) { return t.name == chosen; });
  const std::string closed = now != tissues.end() ? label(*now)
                             : chosen.empty()     ? tr("choose a tissue")
                                                  : tr("{} (not known)", chosen);
  if (!begin_picture_list(id, closed, material_called(modeller::material_of_tissue(chosen)))) return false;
  bool changed = false;
  for (const modeller::TissueChoice& t : tissues)
    if (picture_row(label(t), t.name, material_called(modeller::material_of_tissue(t.name)), t.name == chosen))
      chosen = t.name, changed = true;
  ImGui::EndCombo();
  return changed;
}

bool draw_material_list(const std::string& id, std::string& chosen) {
  const std::string closed = chosen.empty() ? std::string(tr("by the body's name")) : spaced(chosen);
  if (!begin_picture_list(id, closed, material_called(chosen))) return false;
  bool changed = false;
  for (const modeller::MaterialChoice& m : modeller::material_choices())
    if (picture_row(spaced(m.name), m.name, &m, m.name == chosen)) chosen = m.name, changed = true;
  ImGui::EndCombo();
  return changed;
}

}  // namespace trocar::app
