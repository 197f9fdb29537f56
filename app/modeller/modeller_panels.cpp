// What stands around the views: menus, the list of things, the status line.
#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>

#include <trocar/core/text.hpp>
#include <trocar/modeller/document/plain_words.hpp>

#include "modeller/modeller_parts.hpp"

namespace trocar::app {
namespace {

bool item(const char* label, const char* keys = nullptr, bool on = false, bool enabled = true) {
  const bool pressed = ImGui::MenuItem(label, keys, on, enabled);
  ui::note_widget(label);
  return pressed;
}

bool menu(const char* label) {
  const bool open = ImGui::BeginMenu(label);
  ui::note_widget(std::string("menu ") + label);
  return open;
}

void begin_panel(const char* name, const Area& area) {
  ImGui::SetNextWindowPos({area.x, area.y});
  ImGui::SetNextWindowSize({area.width, area.height});
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoBringToFrontOnFocus);
}

}  // namespace

void Modeller::draw_file_menu() {
  if (item(tr("New organ"))) begin_organ();
  if (item(tr("New scene"))) begin_scene();
  if (item(tr("Open ..."), "Ctrl-O")) ask_for_file(FileFor::open);
  if (ImGui::BeginMenu(tr("Open recent"), !m_recent.empty())) {
    fs::path wanted;
    for (const fs::path& file : m_recent)
      if (ImGui::MenuItem(file.generic_string().c_str())) wanted = file;
    ImGui::EndMenu();
    if (!wanted.empty()) m_to_open = wanted, m_after = After::open, leave();
  }
  ImGui::Separator();
  if (item(tr("Save"), "Ctrl-S", false, m_untitled || !m_document->unsaved().empty())) save();
  if (item(tr("Save as ..."), "Ctrl-Shift-S")) ask_for_file(FileFor::save_as);
  if (item(tr("Save a copy to send ..."))) ask_for_file(FileFor::send);
  ImGui::Separator();
  if (item(tr("Import an organ ..."))) {
    m_draw_for.clear();
    m_body_by = "from_file";
    ask_for_file(FileFor::body);
  }
  if (item(tr("Export the chosen organ ..."), nullptr, false, !m_selected.empty())) ask_for_file(FileFor::export_body);
  ImGui::Separator();
  if (item(tr("Start screen"))) m_after = After::start, leave();
  if (item(tr("Quit"), "Ctrl-Q")) m_after = After::quit, leave();
}

void Modeller::draw_edit_menu() {
  const std::size_t done = m_document->done();
  const std::string last = done > 0 ? tr("Undo {}", m_document->history()[done - 1].name) : std::string(tr("Undo"));
  if (ImGui::MenuItem(last.c_str(), "Ctrl-Z", false, done > 0)) undo();
  ui::note_widget("Undo");
  if (item(tr("Redo"), "Ctrl-Shift-Z", false, done < m_document->history().size())) redo();
  if (item(tr("History"), nullptr, m_history)) m_history = !m_history;
  ImGui::Separator();
  if (item(tr("Soft move"), "O", m_soft)) m_soft = !m_soft;
  if (item(tr("Move both sides"), nullptr, m_symmetric)) m_symmetric = !m_symmetric;
  if (item(tr("Snap to bodies"), "Shift-Tab", m_snap)) m_snap = !m_snap;
  if (item(tr("Paint on the chosen body"), "B", m_brush.on)) toggle_brush();
  if (item(tr("Measure"), "M", m_measuring)) m_measuring = !m_measuring, m_measured.clear();
}

void Modeller::draw_add_menu() {
  static constexpr std::pair<const char*, const char*> kDrawn[] = {{"Draw a tube or cord", "cord"},
                                                                   {"Draw a body along a line", "loft"},
                                                                   {"Draw a tree of vessels", "vessel_tree"},
                                                                   {"Draw a branch of the chosen vessel", "branch"},
                                                                   {"Draw fibres on the chosen body", "fibres"}};
  for (const auto& [label, operation] : kDrawn)
    if (item(tr(label))) {
      m_draw_for = operation;
      m_drawn.clear();
      tell(tr("Click from place to place, on bodies or in the air. Enter ends the line, Esc cancels it."));
    }
  ImGui::Separator();
  static constexpr std::pair<const char*, const char*> kAsked[] = {
      {"Ball or ellipsoid ...", "ellipsoid"},
      {"Body of revolution ...", "revolved"},
      {"Membrane between a cord and an organ ...", "fold"},
      {"Bond a hollow organ to an organ ...", "bond_facing"},
      {"Convert the chosen body to NURBS ...", "to_spline"},
      {"Insert a knot into the chosen body ...", "insert_knot"},
      {"Attach the chosen body ...", "hold"},
      {"Fibres of the chosen body ...", "fibres"}};
  for (const auto& [label, operation] : kAsked)
    if (item(tr(label))) m_adding = operation, m_asked.clear(), tell("");
  ImGui::Separator();
  if (item(tr("Fit a NURBS surface to a file ..."))) {
    m_draw_for.clear();
    m_body_by = "fit_spline";
    ask_for_file(FileFor::body);
  }
}

void Modeller::draw_scene_menu() {
  static constexpr std::pair<const char*, const char*> kPlaced[] = {{"Add a port ...", "port"},
                                                                    {"Place an instrument ...", "tool"},
                                                                    {"Place the endoscope ...", "scope"},
                                                                    {"Add a mark ...", "mark"}};
  for (const auto& [label, operation] : kPlaced)
    if (item(tr(label))) {
      m_draw_for = operation;
      m_drawn.clear();
      tell(tr("Click its place, on a body or in the air. Esc cancels it."));
    }
  ImGui::Separator();
  if (item(tr("Position of the patient ..."))) m_adding = "tilt", m_asked.clear(), tell("");
  if (item(tr("Patient variation ..."))) m_adding = "vary", m_asked.clear(), tell("");
}

void Modeller::draw_view_menu() {
  if (item(tr("Show all of it"), "F")) frame_selected();
  if (item(tr("From the feet"), "1")) look_from(1);
  if (item(tr("From the side"), "3")) look_from(2);
  if (item(tr("From the front"), "7")) look_from(3);
  if (item(tr("From above the feet"), "5")) look_from(0);
  if (item(tr("Hide the chosen body"), "H", false, !m_selected.empty()))
    if (const std::optional<modeller::Thing> chosen = selected()) m_hidden.insert(chosen->name), ++m_picture;
  if (item(tr("Show all"), "Alt-H", false, !m_hidden.empty())) m_hidden.clear(), ++m_picture;
  if (item(tr("Instruments"), nullptr, m_instruments)) m_instruments = !m_instruments, ++m_picture;
  if (item(tr("Four views"), "Ctrl-Alt-Q", m_four)) m_four = !m_four, ++m_picture;
}

void Modeller::draw_menu_bar() {
  if (!ImGui::BeginMainMenuBar()) return;
  const std::pair<const char*, void (Modeller::*)()> menus[] = {
      {"File", &Modeller::draw_file_menu},   {"Edit", &Modeller::draw_edit_menu}, {"Add", &Modeller::draw_add_menu},
      {"Scene", &Modeller::draw_scene_menu}, {"Scan", &Modeller::draw_scan_menu}, {"View", &Modeller::draw_view_menu}};
  for (const auto& [label, draw] : menus)
    if (m_document && menu(tr(label))) {
      (this->*draw)();
      ImGui::EndMenu();
    }
  if (menu(tr("Help"))) {
    if (item(tr("Keys"), "F1")) m_help = true;
    ImGui::EndMenu();
  }
  ImGui::SetCursorPosX(ImGui::GetWindowWidth() - 330 * ui::scale());
  if (ImGui::SmallButton(m_drive ? tr("End test drive (T)") : tr("Test drive (T)")) && m_document) toggle_drive();
  ui::note_widget("Test drive");
  ImGui::SameLine(0, 12 * ui::scale());
  ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(0.10f, 0.40f, 0.58f, 1));
  if (ImGui::SmallButton(tr("Operate (F5)")) && m_document) operate();
  ImGui::PopStyleColor();
  ui::note_widget("Operate");
  m_bar = ImGui::GetWindowHeight();
  ImGui::EndMainMenuBar();
}

void Modeller::draw_outline() {
  begin_panel("things", m_left);
  std::string kind;
  for (const modeller::Thing& t : m_things) {
    if (t.kind == "tissue" || t.kind == "instrument") continue;
    if (t.kind != kind) ui::heading(modeller::label_of_kind(t.kind, true));
    kind = t.kind;
    const std::string id = t.kind + ":" + t.name;
    if (ImGui::Selectable((t.name + "##" + id).c_str(), id == m_selected)) select(id), m_handle.reset();
    ui::note_widget(id);
  }
  if (m_things.empty())
    ui::text(tr("Nothing yet. Add a ball, a tube or a vessel (Add), or import an organ (File)."), ui::kGrey);
  if (m_history) {
    ui::heading(tr("History"));
    for (std::size_t i = 0; i < m_document->history().size(); ++i) {
      const bool past = i < m_document->done();
      const std::string label = fmt::format("{}##h{}", m_document->history()[i].name, i);
      if (ImGui::Selectable(label.c_str(), i + 1 == m_document->done())) {
        while (m_document->done() > i + 1) m_document->undo();
        while (m_document->done() < i + 1) m_document->redo();
      }
      if (!past) {
        ImGui::SameLine();
        ui::text(tr("(undone)"), ui::kGrey);
      }
    }
  }
  ImGui::End();
}

/// First line: the last message, or what can be done. Second line: the document, or its first fault.
void Modeller::draw_status() {
  begin_panel("status", m_bottom);
  const float width = m_bottom.width - 20;
  if (m_is_error && !m_message.empty()) {
    ui::mark(ui::Mark::error);
    ui::text(ui::shortened(m_message, width - 40), ui::kOrange);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", ui::wrapped(m_message, 600 * ui::scale()).c_str());
  } else {
    const char* hint =
        tr("Click: choose   right drag: turn   G R S: move, rotate, scale   T: test drive   F1: all keys");
    ui::text(ui::shortened(m_message.empty() ? hint : m_message, width), ui::kGrey);
  }
  const std::vector<core::Fault>* faults = m_built ? &m_built->built.faults : nullptr;
  const std::vector<modeller::Finding>* findings = findings_now();
  const bool one_click_mends = findings && !findings->empty() && !findings->front().steps.empty();
  if (faults && !faults->empty() && !one_click_mends) {
    ui::mark(ui::Mark::error);
    const std::string place = modeller::fault_in_words(faults->front());
    ui::text(ui::shortened(faults->size() > 1 ? tr("{}  (and {} more)", place, faults->size() - 1) : place,
                           m_bottom.width - 160),
             ui::kOrange);
    ImGui::SameLine(m_bottom.width - 110 * ui::scale());
    if (ImGui::SmallButton(tr("Show all"))) m_faults = true;
    ui::note_widget("Show all faults");
  } else if (findings && !findings->empty() && findings->front().about != modeller::Finding::About::organ) {
    const modeller::Finding finding = findings->front();
    ui::mark(ui::Mark::warning);
    ui::text(ui::shortened(finding.words, m_bottom.width - 260 * ui::scale()), ui::kOrange);
    if (!finding.remedy.empty() && !finding.steps.empty()) {
      ImGui::SameLine(m_bottom.width - 210 * ui::scale());
      if (ImGui::SmallButton(finding.remedy.c_str())) do_remedy(finding);
      ui::note_widget("remedy");
    }
  } else {
    const std::string name = m_untitled ? std::string(tr("Untitled")) : m_document->root().filename().string();
    const std::string saved = needs_saving() ? tr("{} (not saved)", name) : name;
    ui::text(m_builder.busy() ? tr("{}   compiling ...", saved) : saved, ui::kGrey);
  }
  ImGui::End();
}

}  // namespace trocar::app
