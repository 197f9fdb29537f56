// The first screen: what can be begun, what was open lately, what comes with the program.
#include <fmt/format.h>
#include <imgui.h>

#include <trocar/attempt/paths.hpp>
#include <trocar/core/text.hpp>
#include <trocar/scene/files/reader.hpp>

#include "modeller/modeller_parts.hpp"

namespace trocar::app {
namespace {

constexpr float kButton = 210, kWords = 230;  // [px at scale 1]

/// A button with a line beside it.
bool begins(const char* label, const char* words, bool primary = false) {
  const bool pressed = ui::button(label, {.width = kButton, .height = 34, .primary = primary});
  ImGui::SameLine(kWords * ui::scale());
  ImGui::AlignTextToFramePadding();
  ui::text(words, ui::kGrey);
  return pressed;
}

}  // namespace

void Modeller::draw_start() {
  ui::begin_screen("start");
  ImGui::BeginDisabled(asks());
  ui::title(tr("Model an organ"));
  ui::text(tr("Shape or import an organ, then operate on it with the trainer."), ui::kGrey);
  ImGui::Spacing();
  if (begins(tr("New organ"), tr("An organ to shape, attached and in the endoscope's view. Operate at once."), true))
    begin_organ();
  if (begins(tr("New scene"), tr("An empty scene with ports and instruments, for organs from files."))) begin_scene();
  if (begins(tr("Open a scan"), tr("CT or MRI: segment an organ and operate on it."))) ask_for_file(FileFor::scan);
  if (begins(tr("Try a uterus"), tr("A finished example to look at, change and operate on."))) open_sample();
  if (begins(tr("Open"), tr("A scene or an organ that you saved."))) ask_for_file(FileFor::open);
  ui::text(m_message.empty() ? " " : m_message, m_is_error ? ui::kOrange : ui::kGrey);
  fs::path wanted;
  if (!m_recent.empty()) {
    ui::heading(tr("Recent files"));
    for (const fs::path& file : m_recent) {
      std::error_code error;
      if (!fs::exists(file, error)) continue;
      if (ImGui::Selectable(
              fmt::format("{}   {}##recent", file.filename().string(), file.parent_path().string()).c_str()))
        wanted = file;
      ui::note_widget("recent " + file.filename().string());
    }
  }
  if (ImGui::TreeNode(tr("Scenes that come with Trocar"))) {
    guarded([&] {
      for (const scene::SceneEntry& s : scene::list_scenes(attempt::scenes_folder())) {
        if (ImGui::Selectable((s.title + "##" + s.name).c_str())) wanted = s.path;
        ui::note_widget("scene " + s.name);
      }
    });
    ImGui::TreePop();
  }
  ImGui::EndDisabled();
  ImGui::End();
  if (wanted.empty()) return;
  m_to_open = wanted;
  m_after = After::open;
  leave();
}

}  // namespace trocar::app
