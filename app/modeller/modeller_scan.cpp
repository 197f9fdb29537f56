// The scan beside the document: its menu, its views, and organs made of its segments.
#include <cctype>

#include <fmt/format.h>
#include <imgui.h>

#include <trocar/core/text.hpp>
#include <trocar/modeller/scan/segment_organ.hpp>

#include "modeller/modeller_parts.hpp"

namespace trocar::app {

void Modeller::draw_scan_menu() {
  const auto entry = [](const char* label, const char* keys, bool enabled) {
    const bool pressed = ImGui::MenuItem(label, keys, false, enabled);
    ui::note_widget(label);
    return pressed;
  };
  if (entry(tr("Open scan ..."), nullptr, !m_scan.reads())) ask_for_file(FileFor::scan);
  if (entry(tr("Open label map ..."), nullptr, m_scan.shows())) ask_for_file(FileFor::labels);
  if (entry(tr("Save label map ..."), nullptr, m_scan.shows())) ask_for_file(FileFor::write_labels);
  if (m_lost_segments && entry(tr("Last session's segments"), nullptr, !m_scan.reads())) {
    m_scan.open(m_lost_segments->scan, m_lost_segments->labels);
    m_scan_shown = true;
    m_lost_segments.reset();
  }
  ImGui::Separator();
  if (entry(m_scan_shown ? tr("Show the document") : tr("Show the scan"), "Tab", m_scan.shows()))
    m_scan_shown = !m_scan_shown;
  if (entry(tr("Close scan"), nullptr, m_scan.shows())) m_scan.close(), m_scan_shown = false;
}

void Modeller::draw_scan() {
  m_scan.draw(m_middle, m_right);
  const ScanMessage said = m_scan.take_message();
  if (!said.text.empty()) {
    said.error ? warn(said.text) : tell(said.text);
    m_log.event("scan", {{"said", said.text}, {"error", said.error}});
  }
  if (!m_scan.shows()) {
    const char* text = m_scan.reads() ? tr("Reading the scan ...") : "";
    ImGui::GetBackgroundDrawList()->AddText({m_middle.x + 24, m_middle.y + 24}, IM_COL32(190, 195, 200, 255), text);
  }
  if (const std::string segment = m_scan.take_wanted_organ(); !segment.empty()) make_organ(segment);
}

/// With what suits most; everything else can be changed among its properties.
void Modeller::make_organ(const std::string& segment) {
  modeller::OrganWish wish;
  wish.segment = segment;
  std::string name = segment;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  wish.name = free_name(name);
  wish.tissue = modeller::tissue_for_name(segment, tissues());
  if (wish.tissue.empty()) wish.tissue = "liver";
  wish.look = modeller::material_for(segment, wish.tissue);
  wish.attach = true;
  std::vector<core::Fault> ignored;
  const std::optional<scene::Description> d = m_document->description(ignored);
  wish.place_mm = [&d](Vec3d size_mm) {
    const std::optional<Vec3d> to = d ? modeller::place_in_view(*d, size_mm * 1e-3) : std::nullopt;
    return to ? *to * 1e3 : Vec3d{0, -150, -120};
  };
  guarded([&] {
    const modeller::SegmentOrgan made = modeller::make_organ(*m_document, m_scan.scan(), wish);
    m_scan_shown = false;
    m_things = modeller::outline(*m_document);
    m_things_of = m_document->version();
    select("solid:" + wish.name);
    m_frame_when_built = true;
    tell(tr("{}: {:.1f} mL, its segment {:.1f} mL. Press F5 to operate.", wish.name, made.mL, made.segment_mL));
    m_log.event("organ", {{"name", wish.name}, {"mL", made.mL}, {"segment_mL", made.segment_mL}});
  });
}

}  // namespace trocar::app
