#include <algorithm>

#include <trocar/core/text.hpp>

#include "shell/ui.hpp"
#include "start/pages.hpp"

namespace trocar::app {
namespace {

constexpr std::size_t kMostRows = 300;

std::string length_text(double seconds) {
  const int whole = int(seconds + 0.5);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

void draw_attempt(const PastAttempt& a, StartMemory& memory, StartAnswer& answer) {
  const std::string number = std::to_string(a.number);
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  if (ui::button(tr("Watch") + std::string("##") + number, {.width = 80, .enabled = !a.recording.empty()}))
    answer.program = {tr("The player"), {"replay", a.recording}, {}};
  if (!a.recording.empty()) ui::note_widget("watch " + number);
  first_focus(memory);
  ImGui::SameLine();
  if (ui::button(tr("Report") + std::string("##") + number, {.width = 80})) answer.report_of = a.number;
  ui::note_widget("report " + number);
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(a.when.c_str());
  ImGui::TableNextColumn();
  ui::text(a.title.empty() ? a.exercise : a.title);
  ImGui::TableNextColumn();
  ui::mark(a.passed.value_or(false) ? ui::Mark::done : ui::Mark::note);
  ui::text(result_of(a));
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(length_text(a.seconds).c_str());
}

void draw_table(const std::vector<const PastAttempt*>& attempts, StartMemory& memory, StartAnswer& answer) {
  if (!ImGui::BeginTable("attempts", 5, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) return;
  const float unit = ui::scale();
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, 172 * unit);
  ImGui::TableSetupColumn(tr("Date and time"), ImGuiTableColumnFlags_WidthFixed, 150 * unit);
  ImGui::TableSetupColumn(tr("Exercise"), ImGuiTableColumnFlags_WidthStretch, 3);
  ImGui::TableSetupColumn(tr("Result"), ImGuiTableColumnFlags_WidthStretch, 2);
  ImGui::TableSetupColumn(tr("Duration"), ImGuiTableColumnFlags_WidthFixed, 80 * unit);
  ImGui::TableHeadersRow();
  for (const PastAttempt* a : attempts) draw_attempt(*a, memory, answer);
  ImGui::EndTable();
}

}  // namespace

void draw_recordings_page(const StartContent& c, StartMemory& memory, StartAnswer& answer) {
  std::vector<const PastAttempt*> shown;
  for (const PastAttempt& a : c.past.attempts)
    if ((memory.all_results || worth_listing(a)) && shown.size() < kMostRows) shown.push_back(&a);
  ui::title(c.person.empty() ? tr("Recordings without a name") : tr("Recordings of {}", c.person));
  ui::text(tr("Every attempt is recorded. Watch opens the player; Report makes a page with points and errors."),
           ui::kGrey);
  ui::checkbox(tr("Show attempts of a few seconds, too"), memory.all_results);
  ImGui::BeginChild("list", {0, 0}, false, ImGuiWindowFlags_NavFlattened);
  if (shown.empty()) ui::text(tr("There is no recording yet. Choose an exercise first."), ui::kGrey);
  if (!shown.empty()) draw_table(shown, memory, answer);
  ImGui::EndChild();
}

}  // namespace trocar::app
