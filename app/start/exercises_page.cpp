#include <algorithm>

#include <trocar/core/text.hpp>

#include "shell/ui.hpp"
#include "start/catalogue.hpp"
#include "start/pages.hpp"
#include "start/tile.hpp"

namespace trocar::app {
namespace {

constexpr float kTileWidth = 196, kSideWidth = 184;

void choose_exercise(StartMemory& memory, int exercise) {
  memory.selected = exercise;
  memory.seed = 0;
  memory.open(StartPage::details);
}

/// The groups beside the tiles: one press scrolls to its tiles.
void draw_groups(const std::vector<Group>& groups, StartMemory& memory) {
  const float width = ImGui::GetContentRegionAvail().x / ui::scale();
  for (const Group& g : groups) {
    if (ui::button(g.title + "##group " + g.name, {.width = width, .height = 32})) memory.jump = g.name;
    ui::note_widget("group " + g.name);
    if (g.tasks > 0) ui::text(tr("{} of {} passed", g.passed, g.tasks), ui::kGrey);
    ImGui::Dummy({0, 2 * ui::scale()});
  }
}

TileLook tile_of(const StartContent& c, int i, int next) {
  const attempt::ExerciseEntry& e = c.exercises[std::size_t(i)];
  TileLook look;
  look.id = e.name;
  look.title = title_of(e);
  look.texture = c.thumbnail(i);
  if (!e.task) {
    look.detail = tr("No task, no score");
    return look;
  }
  look.over = duration_text(e.expert_time);
  look.detail = title_of_level(e.level);
  if (i == next) look.badge = tr("Next for you");
  const auto standing = c.past.standings.find(e.name);
  if (standing == c.past.standings.end()) {
    look.result = tr("Not tried yet");
    return look;
  }
  look.passed = standing->second.passed;
  look.result = look.passed ? tr("Passed, best {:.0f}", standing->second.best.value_or(0))
                            : tr("Best {:.0f} of 100", standing->second.best.value_or(0));
  return look;
}

/// Tiles of a group in rows, each as high as its highest.
void draw_tiles(const StartContent& c, const Group& group, int next, StartMemory& memory) {
  const float gap = ImGui::GetStyle().ItemSpacing.x, room = ImGui::GetContentRegionAvail().x;
  const int columns = std::max(1, int((room + gap) / (kTileWidth * ui::scale() + gap)));
  const float width = (room - float(columns - 1) * gap) / float(columns);
  for (std::size_t first = 0; first < group.exercises.size(); first += std::size_t(columns)) {
    const std::size_t end = std::min(group.exercises.size(), first + std::size_t(columns));
    std::vector<TileLook> row;
    float height = 0;
    for (std::size_t k = first; k < end; ++k) {
      row.push_back(tile_of(c, group.exercises[k], next));
      height = std::max(height, tile_height(row.back(), width));
    }
    for (std::size_t k = first; k < end; ++k) {
      const int exercise = group.exercises[k];
      if (k > first) ImGui::SameLine();
      if (draw_tile(row[k - first], {width, height})) choose_exercise(memory, exercise);
      if (exercise == (memory.selected >= 0 ? memory.selected : next)) first_focus(memory);
    }
  }
}

void draw_search(StartMemory& memory) {
  constexpr float kClear = 30;
  const bool clears = memory.search[0] != 0;
  ImGui::SetNextItemWidth(clears ? -(kClear * ui::scale() + ImGui::GetStyle().ItemSpacing.x) : -1);
  ImGui::InputTextWithHint("##search", tr("Search"), memory.search, sizeof memory.search);
  ui::note_widget("Search");
  if (!clears) return;
  ImGui::SameLine();
  if (ui::button("x##search", {.width = kClear, .tip = tr("Clear the search")})) memory.search[0] = 0;
}

void draw_list(const StartContent& c, const std::vector<Group>& groups, int next, StartMemory& memory) {
  if (c.exercises.empty())
    ui::text(tr("There is no exercise. The folder of scenes seems to be incomplete."), ui::kOrange);
  else if (groups.empty())
    ui::text(tr("No exercise matches \"{}\".", memory.search), ui::kGrey);
  for (const Group& g : groups) {
    if (memory.jump == g.name) {
      ImGui::SetScrollHereY(0);
      memory.jump.reset();
    }
    ui::text(g.title, ui::kBlue);
    draw_tiles(c, g, next, memory);
    ImGui::Dummy({0, 4 * ui::scale()});
  }
}

}  // namespace

void draw_exercises_page(const StartContent& c, StartMemory& memory) {
  const std::vector<Group> all = groups_of(c.exercises, c.past.standings);
  const std::vector<Group> groups =
      memory.search[0] ? groups_of(c.exercises, c.past.standings, memory.search) : std::vector<Group>(all);
  const int next = next_for(c.exercises, c.past.standings);
  ImGui::BeginChild("side", {kSideWidth * ui::scale(), 0}, false, ImGuiWindowFlags_NavFlattened);
  draw_search(memory);
  ImGui::Dummy({0, 2 * ui::scale()});
  draw_groups(all, memory);
  ImGui::EndChild();
  ImGui::SameLine(0, 12 * ui::scale());
  ImGui::BeginChild("tiles", {0, 0}, false, ImGuiWindowFlags_NavFlattened);
  draw_list(c, groups, next, memory);
  ImGui::EndChild();
}

}  // namespace trocar::app
