#include "modeller/import_panel.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <imgui.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/scene/json/json_text.hpp>

#include "modeller/chooser.hpp"
#include "shell/ui.hpp"

namespace trocar::app {
namespace {

using Kind = modeller::ImportPreview::Kind;

constexpr float kLabels = 150;  // [px at scale 1]

void label(const char* text) {
  ui::text(text, ui::kGrey);
  ImGui::SameLine(kLabels * ui::scale());
}

/// Four digits, and all digits of what is larger.
std::string short_length(double mm) { return mm < 1e4 ? fmt::format("{:.4g}", mm) : fmt::format("{:.0f}", mm); }
std::string size_in_words(Vec3d mm) {
  return tr("{} x {} x {} mm", short_length(mm.x), short_length(mm.y), short_length(mm.z));
}

std::string volume_in_words(double mL) {
  if (mL >= 1e6) return tr("{:.0f} L", 1e-3 * mL);
  return mL >= 1000 ? tr("{:.3g} L", 1e-3 * mL) : tr("{:.3g} mL", mL);
}

}  // namespace

void ImportPanel::open(const std::filesystem::path& file, std::string name,
                       std::vector<modeller::TissueChoice> tissues) {
  m_open = m_in_view = m_attach = true;
  m_material_chosen = m_as_surface = false;
  m_file = file;
  m_name = std::move(name);
  m_tissues = std::move(tissues);
  m_trouble.clear();
  m_preview.reset();
  m_part = -1;
  m_cell_mm = 0;
  m_tissue = modeller::tissue_for_name(m_name, m_tissues);
  if (m_tissue.empty() && !m_tissues.empty()) m_tissue = m_tissues[m_tissues.size() / 2].name;
  m_material = modeller::material_for(m_name, m_tissue);
  m_reading = std::async(std::launch::async, [file] { return modeller::preview_of(file); });
}

void ImportPanel::take_what_was_read() {
  if (!m_reading.valid() || m_reading.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  try {
    m_preview = m_reading.get();
    m_unit = m_preview->guess;
    if (m_preview->kind == Kind::drawing && !m_preview->parts.empty()) m_part = 0;
  } catch (const core::BadInput& bad) {
    m_trouble = tr("This file cannot be imported: {}", bad.faults().front().message);
  } catch (const std::exception& failed) {
    m_trouble = tr("This file cannot be imported: {}", failed.what());
  }
}

Vec3d ImportPanel::size_mm() const {
  if (!m_preview) return {};
  if (m_part < 0) return m_preview->size_mm(m_unit);
  const geometry::Bounds& box = m_preview->parts[std::size_t(m_part)].box;
  return (box.high - box.low) * (1e3 * m_unit);
}

Vec3d ImportPanel::middle_mm() const {
  if (!m_preview) return {};
  if (m_part < 0) return m_preview->middle_mm(m_unit);
  const geometry::Bounds& box = m_preview->parts[std::size_t(m_part)].box;
  return (box.high + box.low) * (0.5e3 * m_unit);
}

double ImportPanel::volume_mL(double unit) const {
  const double inside = m_part < 0 ? m_preview->volume : m_preview->parts[std::size_t(m_part)].volume;
  return 1e6 * inside * unit * unit * unit;
}

void ImportPanel::draw_units() {
  label(tr("Unit of the file"));
  ImGui::BeginGroup();
  const double now = m_unit;
  for (const double unit : m_preview->units()) {
    m_unit = unit;
    const std::string words =
        tr("{}:  {}, {}", geometry::unit_in_words(unit), size_in_words(size_mm()), volume_in_words(volume_mL(unit)));
    m_unit = now;
    const char* why = std::fabs(unit - m_preview->guess) > 1e-9 ? ""
                      : m_preview->metres > 0                   ? tr("(says the file)")
                                                                : tr("(our guess)");
    if (ImGui::RadioButton((words + "   " + why).c_str(), std::fabs(now - unit) < 1e-9)) m_unit = unit;
    ui::note_widget(std::string("unit ") + (unit >= 1 ? "m" : unit >= 0.01 ? "cm" : "mm"));
    if (m_unit != now) break;
  }
  ImGui::EndGroup();
  const bool sensible = geometry::is_organs_volume({{}, 1e-6 * volume_mL(m_unit)}, 1);
  if (!sensible) ui::text(tr("Organs hold 0.1 mL to 20 L. Choose the unit of the file."), ui::kOrange);
}

void ImportPanel::draw_notes() {
  constexpr std::size_t kShown = 4;
  for (std::size_t i = 0; i < std::min(kShown, m_preview->notes.size()); ++i)
    ui::text(ui::shortened(m_preview->notes[i], 600 * ui::scale()), ui::kGrey);
}

void ImportPanel::draw_parts() {
  if (m_preview->parts.size() < 2) return;
  label(tr("Part of the file"));
  const bool drawing = m_preview->kind == Kind::drawing;
  const std::string shown =
      m_part < 0 ? tr("all {} parts", m_preview->parts.size()) : m_preview->parts[std::size_t(m_part)].name;
  ImGui::SetNextItemWidth(-1);
  if (!ImGui::BeginCombo("##part", shown.c_str())) return;
  if (!drawing && ImGui::Selectable(tr("all parts"), m_part < 0)) m_part = -1;
  for (int i = 0; i < int(m_preview->parts.size()); ++i) {
    const std::string row = m_preview->parts[std::size_t(i)].name + "##" + std::to_string(i);
    if (ImGui::Selectable(row.c_str(), i == m_part)) m_part = i;
  }
  ImGui::EndCombo();
}

void ImportPanel::draw_fields() {
  label(tr("Name"));
  char text[128];
  std::snprintf(text, sizeof text, "%s", m_name.c_str());
  ImGui::SetNextItemWidth(-1);
  if (ImGui::InputText("##name", text, sizeof text)) m_name = text;
  ui::note_widget("import name");
  label(tr("Tissue"));
  ImGui::SetNextItemWidth(-1);
  if (draw_tissue_list("##import tissue", m_tissues, m_tissue) && !m_material_chosen)
    m_material = modeller::material_of_tissue(m_tissue);
  label(tr("Material"));
  ImGui::SetNextItemWidth(-1);
  if (draw_material_list("##import material", m_material)) m_material_chosen = true;
  label(tr("Place"));
  ImGui::BeginGroup();
  if (ImGui::RadioButton(tr("In view of the endoscope"), m_in_view)) m_in_view = true;
  ui::note_widget("in view");
  const Vec3d middle = middle_mm();
  const std::string keep = tr("Keep the file's position ({:.0f}, {:.0f}, {:.0f}) mm", middle.x, middle.y, middle.z);
  if (ImGui::RadioButton(keep.c_str(), !m_in_view)) m_in_view = false;
  ui::note_widget("keep position");
  ImGui::EndGroup();
  label(tr("Attachment"));
  ui::checkbox(tr("Attach its middle, so that it does not fall"), m_attach);
}

void ImportPanel::draw_details() {
  if (!ImGui::TreeNode(tr("Details"))) return;
  label(tr("Cell size (mm)"));
  ImGui::SetNextItemWidth(160 * ui::scale());
  ImGui::InputDouble("##cell", &m_cell_mm, 0, 0, m_cell_mm > 0 ? "%.2f" : tr("automatic"));
  m_cell_mm = m_cell_mm > 0 ? std::clamp(m_cell_mm, 0.1, 100.0) : 0;
  if (m_preview->kind == Kind::drawing) {
    label(tr("Deviation (mm)"));
    ImGui::SetNextItemWidth(160 * ui::scale());
    ImGui::InputDouble("##within", &m_deviation_mm, 0, 0, "%.3f");
    m_deviation_mm = std::clamp(m_deviation_mm, 0.001, 10.0);
    ui::checkbox(tr("As triangles, also where it is one smooth surface"), m_as_surface);
  }
  ImGui::TreePop();
}

bool ImportPanel::draw() {
  take_what_was_read();
  ui::begin_middle("import", 640);
  ui::title(tr("Import {}", m_file.filename().string()));
  if (m_preview) {
    const bool surface = m_preview->kind == Kind::surface;
    if (surface)
      ui::text(m_preview->closed ? tr("Closed surface, {} triangles.", m_preview->triangles)
                                 : tr("Open surface, {} triangles: its holes will be closed.", m_preview->triangles),
               ui::kGrey);
    draw_notes();
    draw_parts();
    draw_units();
    draw_fields();
    draw_details();
  } else if (m_trouble.empty()) {
    ui::text(tr("Reading the file ..."), ui::kGrey);
  }
  ui::text(m_trouble.empty() ? " " : m_trouble, ui::kOrange);
  const bool done = ui::button(tr("Import"), {.width = 140, .primary = true, .enabled = m_preview && !m_name.empty()});
  ImGui::SameLine();
  if (ui::button(tr("Cancel"), {.width = 140})) m_open = false;
  ImGui::End();
  if (done) m_trouble.clear();
  return done && m_open;
}

scene::JsonValue ImportPanel::made_step(std::optional<Vec3d> centre_mm) const {
  scene::JsonValue s = scene::json_object();
  scene::put(s, "do", scene::json_text("from_file"));
  scene::put(s, "file", scene::json_text(m_file.generic_string()));
  scene::put(s, "name", scene::json_text(m_name));
  scene::put(s, "tissue", scene::json_text(m_tissue));
  if (!m_material.empty()) scene::put(s, "look", scene::json_text(m_material));
  const bool drawing = m_preview->kind == Kind::drawing;
  if (m_part >= 0) scene::put(s, "part", scene::json_text(m_preview->parts[std::size_t(m_part)].name));
  scene::put(s, "unit_mm", scene::json_number(1e3 * m_unit));
  if (m_cell_mm > 0) scene::put(s, "cell_mm", modeller::number(m_cell_mm));
  if (drawing) scene::put(s, "within_mm", scene::json_number(m_deviation_mm));
  if (drawing && m_as_surface) scene::put(s, "as", scene::json_text("surface"));
  if (centre_mm) scene::put(s, "place_mm", modeller::point(*centre_mm - middle_mm()));
  return s;
}

}  // namespace trocar::app
