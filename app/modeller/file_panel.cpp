#include "modeller/file_panel.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <imgui.h>

#include <trocar/core/letters.hpp>
#include <trocar/core/text.hpp>

#include "shell/ui.hpp"

namespace trocar::app {

namespace fs = std::filesystem;

namespace {

constexpr float kPlacesWidth = 170, kListHeight = 300;  // [px at scale 1]
constexpr std::size_t kMostRecentFolders = 4;

fs::path home_folder() {
  const char* home = std::getenv("HOME");
  return home ? home : "/";
}

/// Drives that a desktop mounts for people.
std::vector<fs::path> mounted_drives() {
  std::vector<fs::path> out;
  std::ifstream mounts("/proc/mounts");
  for (std::string line; std::getline(mounts, line);) {
    std::istringstream words(line);
    std::string device, folder;
    words >> device >> folder;
    for (std::size_t at; (at = folder.find("\\040")) != std::string::npos;) folder.replace(at, 4, " ");
    for (const char* above : {"/media/", "/mnt/", "/run/media/"})
      if (folder.rfind(above, 0) == 0) out.emplace_back(folder);
  }
  return out;
}

}  // namespace

void FilePanel::open(FileWish wish) {
  m_wish = std::move(wish);
  m_open = m_takes_focus = true;
  m_all = m_making_folder = false;
  m_trouble.clear();
  find_places();
  const fs::path start = m_last.empty() ? home_folder() : m_last;
  const fs::path at = m_wish.at.empty() ? start : m_wish.at.has_parent_path() ? m_wish.at : start / m_wish.at;
  std::error_code error;
  const bool folder = fs::is_directory(at, error);
  m_name = folder ? "" : at.filename().string();
  go_to(folder ? at : at.parent_path());
}

void FilePanel::find_places() {
  m_places.clear();
  std::error_code error;
  const fs::path home = home_folder();
  m_places.push_back({tr("Home"), home});
  for (const char* name : {"Desktop", "Documents", "Downloads"})
    if (fs::is_directory(home / name, error)) m_places.push_back({tr(name), home / name});
  for (const fs::path& drive : mounted_drives()) m_places.push_back({drive.filename().string(), drive});
  m_places.push_back({tr("Computer"), "/"});
  std::size_t recent = 0;
  for (const fs::path& file : m_recent) {
    const fs::path folder = file.parent_path();
    const bool known =
        std::any_of(m_places.begin(), m_places.end(), [&](const Place& p) { return p.folder == folder; });
    if (known || recent == kMostRecentFolders || !fs::is_directory(folder, error)) continue;
    m_places.push_back({folder.filename().string(), folder});
    ++recent;
  }
}

bool FilePanel::is_shown(const fs::path& file) const {
  if (m_all || m_wish.endings.empty()) return true;
  const std::string ending = core::in_small_letters(file.extension().string());
  return std::find(m_wish.endings.begin(), m_wish.endings.end(), ending) != m_wish.endings.end();
}

void FilePanel::go_to(const fs::path& folder) {
  std::error_code error;
  m_folder = folder.empty() ? fs::current_path(error) : fs::weakly_canonical(folder, error);
  while (!fs::is_directory(m_folder, error) && m_folder.has_relative_path()) m_folder = m_folder.parent_path();
  m_folders.clear();
  m_files.clear();
  fs::directory_iterator at(m_folder, fs::directory_options::skip_permission_denied, error);
  m_trouble = error ? tr("This folder cannot be read: {}", error.message()) : "";
  for (; !error && at != fs::directory_iterator(); at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (name.empty() || name[0] == '.') continue;
    std::error_code ignored;
    if (at->is_directory(ignored))
      m_folders.push_back(at->path());
    else if (is_shown(at->path()))
      m_files.push_back(at->path());
  }
  std::sort(m_folders.begin(), m_folders.end());
  std::sort(m_files.begin(), m_files.end());
}

void FilePanel::draw_places(fs::path& next) {
  ImGui::BeginChild("places", ImVec2(kPlacesWidth * ui::scale(), kListHeight * ui::scale()), true);
  for (std::size_t i = 0; i < m_places.size(); ++i) {
    const Place& place = m_places[i];
    if (ImGui::Selectable((place.name + "##place" + std::to_string(i)).c_str(), place.folder == m_folder))
      next = place.folder;
    ui::note_widget("place " + place.name);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", place.folder.string().c_str());
  }
  ImGui::EndChild();
}

bool FilePanel::draw_list(fs::path& next) {
  bool done = false;
  ImGui::BeginChild("list", ImVec2(0, kListHeight * ui::scale()), true);
  if (m_folder.has_parent_path() && m_folder != m_folder.root_path())
    if (ImGui::Selectable(tr(".. (folder above)"))) next = m_folder.parent_path();
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
  if (m_folders.empty() && m_files.empty())
    ui::text(m_trouble.empty() ? tr("Nothing to show in this folder.") : m_trouble, ui::kGrey);
  ImGui::EndChild();
  return done;
}

void FilePanel::draw_new_folder(fs::path& next) {
  char text[256];
  std::snprintf(text, sizeof text, "%s", m_new_folder.c_str());
  ImGui::SetNextItemWidth(260 * ui::scale());
  const bool entered = ImGui::InputTextWithHint("##folder", tr("name of the new folder"), text, sizeof text,
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  ui::note_widget("folder name");
  m_new_folder = text;
  ImGui::SameLine();
  const bool make = ui::button(tr("Create folder"), {.enabled = !m_new_folder.empty()});
  if ((!entered && !make) || m_new_folder.empty()) return;
  std::error_code error;
  fs::create_directory(m_folder / m_new_folder, error);
  if (error) {
    m_trouble = tr("The folder cannot be created: {}", error.message());
    return;
  }
  next = m_folder / m_new_folder;
  m_making_folder = false;
}

/// True: other files are shown from now on.
bool FilePanel::draw_filter() {
  if (m_wish.endings.empty()) return false;
  std::string kinds;
  for (const std::string& ending : m_wish.endings) kinds += (kinds.empty() ? "" : " ") + ending;
  const bool before = m_all;
  ImGui::SetNextItemWidth(260 * ui::scale());
  if (ImGui::BeginCombo("##kinds", m_all ? tr("All files") : ui::shortened(kinds, 220 * ui::scale()).c_str())) {
    if (ImGui::Selectable(kinds.c_str(), !m_all)) m_all = false;
    if (ImGui::Selectable(tr("All files"), m_all)) m_all = true;
    ImGui::EndCombo();
  }
  return m_all != before;
}

/// What the line says; its ending is added where a file of one kind only can be saved.
fs::path FilePanel::named() const {
  fs::path path = fs::path(m_name).is_absolute() ? fs::path(m_name) : m_folder / m_name;
  if (m_wish.saves && m_wish.endings.size() == 1 && path.extension() != m_wish.endings.front())
    path += m_wish.endings.front();
  return path;
}

bool FilePanel::draw(fs::path& chosen) {
  ui::begin_middle("file", 700);
  ui::title(m_wish.title);
  ui::text(ui::shortened(m_folder.string(), 640 * ui::scale()), ui::kGrey);
  fs::path next;
  draw_places(next);
  ImGui::SameLine();
  bool done = draw_list(next);
  char text[512];
  std::snprintf(text, sizeof text, "%s", m_name.c_str());
  ImGui::SetNextItemWidth(-1);
  if (std::exchange(m_takes_focus, false)) ImGui::SetKeyboardFocusHere();
  if (ImGui::InputTextWithHint("##name", tr("file name"), text, sizeof text, ImGuiInputTextFlags_EnterReturnsTrue))
    done = true;
  ui::note_widget("file name");
  m_name = text;
  std::error_code error;
  const bool replaces = m_wish.saves && !m_name.empty() && fs::is_regular_file(named(), error);
  if (!m_trouble.empty())
    ui::text(m_trouble, ui::kOrange);
  else
    ui::text(replaces ? tr("A file of this name exists. It would be replaced.") : " ",
             replaces ? ui::kOrange : ui::kGrey);
  const std::string button = replaces ? tr("Replace") : m_wish.button.c_str();
  done = ui::button(button, {.width = 120, .primary = true, .enabled = !m_name.empty()}) || done;
  ImGui::SameLine();
  if (ui::button(tr("Cancel"), {.width = 120})) m_open = false;
  ImGui::SameLine();
  if (!m_making_folder && ui::button(tr("New folder"), {.width = 130})) m_making_folder = true, m_new_folder.clear();
  if (m_making_folder)
    draw_new_folder(next);
  else if (ImGui::SameLine(), draw_filter())
    next = m_folder;
  ImGui::End();
  if (!next.empty()) go_to(next);
  if (!done || m_name.empty()) return false;
  chosen = named();
  if (fs::is_directory(m_folder / m_name, error)) {
    go_to(m_folder / m_name);
    m_name.clear();
    return false;
  }
  if (!m_wish.saves && !fs::exists(chosen, error)) {
    m_trouble = tr("There is no file \"{}\" here.", m_name);
    return false;
  }
  m_open = false;
  m_last = m_folder;
  return true;
}

}  // namespace trocar::app
