// Operating rooms and instruments: lists of files, each shown in a window of its own.
#include <algorithm>
#include <filesystem>

#include <trocar/core/error.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>
#include <trocar/scene/json/json.hpp>

#include "shell/ui.hpp"
#include "start/pages.hpp"

namespace trocar::app {

namespace fs = std::filesystem;

std::vector<ShownFile> files_of(const std::string& folder) {
  std::vector<ShownFile> files;
  std::error_code error;
  for (const fs::directory_entry& file : fs::directory_iterator(attempt::scenes_folder() / folder, error)) {
    if (file.path().extension() != ".json") continue;
    std::vector<core::Fault> ignored;  // who opens it is told
    const scene::JsonDocument document = scene::load_json(file.path(), ignored);
    const scene::JsonMember* title = document.root.find("title");
    const std::string name = file.path().stem().string();
    files.push_back({name, title ? core::printable(title->value.text) : name});
  }
  std::sort(files.begin(), files.end(), [](const ShownFile& a, const ShownFile& b) { return a.title < b.title; });
  return files;
}

int draw_choices(const std::vector<ShownFile>& files, StartMemory& memory) {
  constexpr float kWidest = 600;
  int chosen = -1;
  const float gap = ImGui::GetStyle().ItemSpacing.x, room = ImGui::GetContentRegionAvail().x;
  const int columns = std::max(1, int(room / (kWidest * ui::scale())));
  const float width = (room - float(columns - 1) * gap) / float(columns) / ui::scale();
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (i % std::size_t(columns) != 0) ImGui::SameLine();
    if (ui::button(files[i].title + "##" + files[i].name, {.width = width, .height = 34})) chosen = int(i);
    ui::note_widget(files[i].name);
    if (i == 0) first_focus(memory);
  }
  return chosen;
}

void draw_rooms_page(StartMemory& memory, StartAnswer& answer) {
  static const std::vector<ShownFile> rooms = files_of("rooms"), programmes = files_of("rooms/programmes");
  ui::title(tr("Operating room"));
  ui::text(tr("An operating room from outside: table, telemanipulator arms and ports. Tilt the table, move a port, and "
              "see which targets the arms reach."),
           ui::kGrey);
  if (const int i = draw_choices(rooms, memory); i >= 0)
    answer.program = {tr("The operating room"), {"room", rooms[std::size_t(i)].name}, {}};
  if (programmes.empty() || rooms.empty()) return;
  ImGui::Dummy({0, 6 * ui::scale()});
  ui::text(tr("With a programme that moves the arms"), ui::kBlue);
  if (const int i = draw_choices(programmes, memory); i >= 0)
    answer.program = {
        tr("The operating room"), {"room", rooms.front().name, "show", programmes[std::size_t(i)].name}, {}};
}

void draw_instruments_page(StartMemory& memory, StartAnswer& answer) {
  static const std::vector<ShownFile> mechanisms = files_of("mechanisms");
  ui::title(tr("Instruments"));
  ui::text(
      tr("Mechanisms of instruments and arms. Move the joints, change dimensions, check clearances and tolerances."),
      ui::kGrey);
  ImGui::BeginChild("list", {0, 0}, false, ImGuiWindowFlags_NavFlattened);
  if (const int i = draw_choices(mechanisms, memory); i >= 0)
    answer.program = {tr("The mechanism"), {"mechanism", mechanisms[std::size_t(i)].name, "design"}, {}};
  ImGui::EndChild();
}

}  // namespace trocar::app
