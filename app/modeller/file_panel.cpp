#include "modeller/file_panel.hpp"

#include <algorithm>

#include <imgui.h>

#include "shell/ui.hpp"

namespace trocar::app {

namespace fs = std::filesystem;

void FilePanel::open(std::string title, std::string button, const fs::path& at, std::vector<std::string> endings) {
  m_title = std::move(title);
  m_button = std::move(button);
  m_endings = std::move(endings);
  m_open = true;
  std::error_code error;
  const bool folder = fs::is_directory(at, error);
  m_name = folder ? "" : at.filename().string();
  go_to(folder ? at : at.parent_path());
}

void FilePanel::go_to(const fs::path& folder) {
  std::error_code error;
  m_folder = folder.empty() ? fs::current_path(error) : fs::weakly_canonical(folder, error);
  m_folders.clear();
  m_files.clear();
  fs::directory_iterator at(m_folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && at != fs::directory_iterator(); at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (name.empty() || name[0] == '.') continue;
    std::error_code ignored;
    if (at->is_directory(ignored))
      m_folders.push_back(at->path());
    else if (m_endings.empty() ||
             std::find(m_endings.begin(), m_endings.end(), at->path().extension()) != m_endings.end())
      m_files.push_back(at->path());
  }
  std::sort(m_folders.begin(), m_folders.end());
  std::sort(m_files.begin(), m_files.end());
}

bool FilePanel::draw(fs::path& chosen) {
  bool done = false;
  ui::begin_middle("file", 640);
  ui::title(m_title);
  ui::text(m_folder.string(), ui::kGrey);
  fs::path next;
  ImGui::BeginChild("list", ImVec2(0, 320 * ui::scale()), true);
  if (m_folder.has_parent_path() && m_folder != m_folder.root_path())
    if (ImGui::Selectable("..")) next = m_folder.parent_path();
  for (const fs::path& folder : m_folders) {
    if (ImGui::Selectable((folder.filename().string() + "/").c_str())) next = folder;
    ui::note_widget(folder.filename().string() + "/");
  }
  for (const fs::path& file : m_files) {
    const std::string name = file.filename().string();
    if (ImGui::Selectable(name.c_str(), name == m_name, ImGuiSelectableFlags_AllowDoubleClick)) {
      m_name = name;
      done = ImGui::IsMouseDoubleClicked(0);
    }
    ui::note_widget(name);
  }
  ImGui::EndChild();
  char text[512];
  std::snprintf(text, sizeof text, "%s", m_name.c_str());
  ImGui::SetNextItemWidth(-1);
  if (ImGui::InputText("##name", text, sizeof text, ImGuiInputTextFlags_EnterReturnsTrue)) done = true;
  ui::note_widget("file name");
  m_name = text;
  done = ui::button(m_button, {.width = 120, .primary = true, .enabled = !m_name.empty()}) || done;
  ImGui::SameLine();
  if (ui::button("Cancel", {.width = 120})) m_open = false;
  ImGui::End();
  if (!next.empty()) go_to(next);
  if (!done || m_name.empty()) return false;
  const fs::path typed(m_name);
  chosen = typed.is_absolute() ? typed : m_folder / typed;
  std::error_code error;
  if (fs::is_directory(chosen, error)) {
    go_to(chosen);
    m_name.clear();
    return false;
  }
  m_open = false;
  return true;
}

}  // namespace trocar::app
