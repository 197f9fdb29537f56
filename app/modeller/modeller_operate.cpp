// Operate: what the document lacks is shown with remedies, what is not saved is asked for, then the trainer opens as a
// program of its own, and what it says against a file is shown here.
#include <fmt/format.h>
#include <imgui.h>

#include <trocar/attempt/paths.hpp>
#include <trocar/core/text.hpp>
#include <trocar/modeller/document/collect.hpp>
#include <trocar/scene/files/reader.hpp>

#include "modeller/chooser.hpp"
#include "modeller/modeller_parts.hpp"

namespace trocar::app {
namespace {

constexpr float kDialogue = 640;

fs::path operate_folder() { return attempt::data_folder() / "modeller" / "operate"; }

/// The trainer's messages without its name before each line.
std::string said_by_trainer(const std::string& errors) { return errors.empty() ? tr("It gave no reason.") : errors; }

}  // namespace

/// Those of the document as it is now; null while it is being compiled.
const std::vector<modeller::Finding>* Modeller::findings_now() const {
  return m_document && m_findings_of == m_document->version() ? &m_findings : nullptr;
}

void Modeller::operate() {
  if (m_drive) toggle_drive();
  if (m_gesture) return;
  m_wants_operate = true;
  tell(tr("Checking the scene ..."));
}

/// As soon as it is known what the document lacks.
void Modeller::continue_operating() {
  if (!m_wants_operate) return;
  const std::vector<modeller::Finding>* findings = findings_now();
  if (!findings) return;
  m_wants_operate = false;
  m_checks = !findings->empty();
  if (m_checks) {
    Json list = Json::array();
    for (const modeller::Finding& f : *findings) list.push_back(f.words);
    m_log.event("checks", {{"findings", list}});
    return tell("");
  }
  if (!m_untitled && !m_document->unsaved().empty())
    m_question = Question::save_and_operate;
  else
    start_trainer();
}

/// The trainer opens on the document as it is saved; on a copy of one that has no name yet, or is an organ alone.
void Modeller::start_trainer() {
  guarded([this] {
    const scene::MemoryFiles memory = m_document->over_disk();
    const bool is_scene = scene::kind_of_file(m_document->root(), &memory) == scene::FileKind::scene;
    const fs::path file =
        m_untitled || !is_scene ? modeller::write_scene_for_trainer(*m_document, operate_folder()) : m_document->root();
    const fs::path log = operate_folder().parent_path() / "trainer_log.jsonl";
    std::error_code ignored;
    fs::remove(log, ignored);
    m_trainer_status.reset();
    m_trainer_is_up = false;
    m_trainer.emplace(std::vector<std::string>{"train", file.generic_string(), "--log", log.generic_string()});
    tell(tr("The trainer is starting ..."));
    m_log.event("operate", {{"started", true}});
  });
}

void Modeller::watch_trainer() {
  if (!m_trainer) return;
  if (m_trainer->running()) {
    std::error_code error;
    const fs::path log = operate_folder().parent_path() / "trainer_log.jsonl";
    if (m_trainer_is_up || !(fs::file_size(log, error) > 0) || error) return;
    m_trainer_is_up = true;
    m_log.event("trainer", {{"up", true}});
    return tell(tr("The trainer is open. Close it to return."));
  }
  const int status = m_trainer->exit_status().value_or(0);
  m_log.event("trainer", {{"status", status}, {"said", m_trainer->errors()}});
  if (status != 0) {
    m_trainer_status = status;
    m_trainer_said = said_by_trainer(m_trainer->errors());
  }
  m_trainer.reset();
  tell("");
}

void Modeller::do_remedy(const modeller::Finding& finding) {
  for (const scene::JsonValue& each : finding.steps)
    if (!step(each)) return;
  if (!finding.steps.empty()) tell(tr("Done: {}", finding.remedy));
  if (finding.about == modeller::Finding::About::view || finding.about == modeller::Finding::About::size)
    m_frame_when_built = true;
}

void Modeller::draw_checks() {
  const std::vector<modeller::Finding>* findings = findings_now();
  ui::begin_middle("checks", kDialogue);
  ui::title(tr("Before you operate"));
  if (!findings) {
    ui::text(tr("Checking the scene ..."), ui::kGrey);
  } else {
    for (std::size_t i = 0; i < findings->size(); ++i) {
      const modeller::Finding& f = (*findings)[i];
      ui::mark(ui::Mark::warning);
      ui::text(f.words);
      if (f.remedy.empty()) continue;
      ImGui::PushID(int(i));
      if (f.about == modeller::Finding::About::tissue) {
        std::string tissue;
        ImGui::SetNextItemWidth(360 * ui::scale());
        if (draw_tissue_list("##check tissue", tissues(), tissue)) choose_tissue(f.thing, tissue);
      } else if (ui::button(f.remedy, {.primary = true})) {
        const modeller::Finding chosen = f;  // what it does changes the list
        do_remedy(chosen);
      }
      ImGui::PopID();
    }
  }
  ui::text(m_is_error ? m_message : " ", ui::kOrange);
  if (ui::button(tr("Cancel"), {.width = 140})) m_checks = false, tell("");
  ImGui::End();
  findings = findings_now();
  if (m_checks && findings && findings->empty()) m_checks = false, m_wants_operate = true;
}

void Modeller::draw_trainer_report() {
  ui::begin_middle("trainer", 760);
  ui::title(tr("The trainer ended with an error"));
  ui::text(tr("Exit status {}. Messages of the trainer:", *m_trainer_status), ui::kGrey);
  ImGui::BeginChild("said", {0, 240 * ui::scale()}, true);
  ui::text(m_trainer_said);
  ImGui::EndChild();
  if (ui::button(tr("Close"), {.width = 120, .primary = true})) m_trainer_status.reset();
  ImGui::End();
}

}  // namespace trocar::app
