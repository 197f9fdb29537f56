// The scan beside the document: its menu, its views, and organs made of its segments.
#include <cctype>

#include <fmt/format.h>
#include <imgui.h>

#include <trocar/core/error.hpp>
#include <trocar/modeller/scan/segment_organ.hpp>

#include "modeller/modeller_parts.hpp"

namespace trocar::app {

void Modeller::draw_scan_menu() {
  const auto entry = [](const char* label, const char* keys, bool enabled) {
    const bool pressed = ImGui::MenuItem(label, keys, false, enabled);
    ui::note_widget(label);
    return pressed;
  };
  const auto ask = [this](FileFor what, const char* title, const char* button, const fs::path& at,
                          std::vector<std::string> endings) {
    m_file_for = what;
    m_files.open(title, button, at, std::move(endings));
  };
  const fs::path folder = m_document->root().parent_path();
  if (entry("Open scan ...", nullptr, !m_scan.reads()))
    ask(FileFor::scan, "A scan: any file of a DICOM series, NIfTI, NRRD, MetaImage", "Read", folder, {});
  if (entry("Open label map ...", nullptr, m_scan.shows()))
    ask(FileFor::labels, "A label map for this scan", "Read", folder, {});
  if (entry("Save label map ...", nullptr, m_scan.shows()))
    ask(FileFor::write_labels, "Where the label map is kept: .nrrd, .nii, .nii.gz", "Save", folder / "labels.seg.nrrd",
        {});
  if (m_lost_segments && entry("Segments of the last time", nullptr, !m_scan.reads())) {
    m_scan.open(m_lost_segments->scan, m_lost_segments->labels);
    m_scan_shown = true;
    m_lost_segments.reset();
  }
  ImGui::Separator();
  if (entry(m_scan_shown ? "Show the document" : "Show the scan", "Tab", m_scan.shows())) m_scan_shown = !m_scan_shown;
  if (entry("Close scan", nullptr, m_scan.shows())) m_scan.close(), m_scan_shown = false;
}

void Modeller::draw_scan() {
  m_scan.draw(m_middle, m_right);
  const std::string said = m_scan.take_message();
  if (!said.empty()) {
    tell(said);
    m_log.event("scan", {{"said", said}});
  }
  if (!m_scan.shows()) {
    const char* text = m_scan.reads() ? "reading the scan ..." : "";
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
  wish.tissue = "liver";
  wish.centre_mm = Vec3d{0, -150, -120};
  try {
    const modeller::SegmentOrgan made = modeller::make_organ(*m_document, m_scan.scan(), wish);
    m_scan_shown = false;
    m_things = modeller::outline(*m_document);
    m_things_of = m_document->version();
    select("solid:" + wish.name);
    tell(fmt::format("{}: {:.1f} mL, its segment {:.1f} mL; hold it (Add), and try it (T)", wish.name, made.mL,
                     made.segment_mL));
    m_log.event("organ", {{"name", wish.name}, {"mL", made.mL}, {"segment_mL", made.segment_mL}});
  } catch (const core::BadInput& bad) {
    tell(bad.faults().front().message);
  }
}

}  // namespace trocar::app
