#include "start/start_screen.hpp"

#include <algorithm>

#include <trocar/core/text.hpp>

#include "shell/ui.hpp"
#include "start/pages.hpp"

namespace trocar::app {
namespace {

bool has_foot(StartPage page) { return page != StartPage::person; }

/// The name of the program, who practises, and the way back.
void draw_head(const StartContent& c, StartMemory& memory, StartAnswer& answer) {
  const float person = 250, height = 34;
  if (memory.page == StartPage::person || memory.page == StartPage::exercises) {
    ui::title(tr("Trocar"));
    ImGui::SameLine(0, 14 * ui::scale());
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() + 8 * ui::scale());
    ImGui::TextUnformatted(tr("Training in endoscopic surgery"));
  } else if (ui::button(tr("All exercises"), {.width = 170, .height = height})) {
    memory.open(StartPage::exercises);
  }
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - person * ui::scale());
  ImGui::SetCursorPosY(ImGui::GetStyle().WindowPadding.y);
  if (has_foot(memory.page)) {
    const std::string who = c.person.empty() ? tr("No name") : c.person;
    if (ui::button(who + "##person", {.width = person, .height = height, .tip = tr("Change person")}))
      memory.open(StartPage::person);
    ui::note_widget("person");
  } else {
    const float third = (person - 2 * ImGui::GetStyle().ItemSpacing.x / ui::scale()) / 3;
    if (ui::button(tr("Settings"), {.width = third, .height = height})) answer.choice = StartChoice::settings;
    ImGui::SameLine();
    if (ui::button(tr("Help"), {.width = third, .height = height})) answer.choice = StartChoice::help;
    ImGui::SameLine();
    if (ui::button(tr("Quit"), {.width = third, .height = height})) answer.choice = StartChoice::quit;
  }
}

/// Everything else that Trocar can do.
void draw_foot(StartMemory& memory, StartAnswer& answer, float height) {
  struct Way {
    const char* title;
    std::optional<StartPage> page;  // nothing: the modeller, which needs none
  };
  const Way ways[] = {{tr("Recordings"), StartPage::recordings},
                      {tr("Model an organ"), {}},
                      {tr("Operating room"), StartPage::rooms},
                      {tr("Instruments"), StartPage::instruments},
                      {tr("Instrument box"), StartPage::box},
                      {tr("Team"), StartPage::team},
                      {tr("More"), StartPage::more}};
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const float width = (ImGui::GetContentRegionAvail().x - gap * float(std::size(ways) - 1)) / float(std::size(ways));
  for (const Way& way : ways) {
    if (&way != ways) ImGui::SameLine();
    const bool here = way.page && *way.page == memory.page;
    if (!ui::button(way.title, {.width = width / ui::scale(), .height = height / ui::scale(), .primary = here}))
      continue;
    if (way.page)
      memory.open(*way.page);
    else
      answer.program = {tr("The modeller"), {"model"}, {}};
  }
}

void draw_page(const StartContent& c, StartMemory& memory, StartAnswer& answer) {
  switch (memory.page) {
    case StartPage::person:
      return draw_person_page(c, memory, answer);
    case StartPage::exercises:
      return draw_exercises_page(c, memory);
    case StartPage::details:
      return draw_details_page(c, memory, answer);
    case StartPage::recordings:
      return draw_recordings_page(c, memory, answer);
    case StartPage::rooms:
      return draw_rooms_page(memory, answer);
    case StartPage::instruments:
      return draw_instruments_page(memory, answer);
    case StartPage::box:
      return draw_box_page(c, memory, answer);
    case StartPage::team:
      return draw_team_page(c, memory, answer);
    case StartPage::more:
      return draw_more_page(c, memory, answer);
  }
}

void go_back(StartMemory& memory) {
  if (memory.page == StartPage::person || memory.page == StartPage::exercises) return;
  memory.open(StartPage::exercises);
}

}  // namespace

const char* name_of(StartPage page) {
  constexpr const char* kNames[] = {"person",      "exercises", "details", "recordings", "rooms",
                                    "instruments", "box",       "team",    "more"};
  return kNames[int(page)];
}

void first_focus(StartMemory& memory) {
  if (memory.fresh <= 0 || ImGui::GetIO().WantTextInput) return;
  ui::take_focus();
  ImGui::SetScrollHereY();
  --memory.fresh;
}

void draw_messages(const StartContent& c, StartAnswer& answer) {
  const std::string& child = c.children.news();
  if (!child.empty()) {
    ui::mark(c.children.refused() ? ui::Mark::error : ui::Mark::now);
    ui::text(child, c.children.refused() ? ui::kRed : ui::kWhite);
    if (c.children.refused() && ui::button(tr("Close message"), {.width = 150})) answer.news_read = true;
  }
  if (!c.news.empty()) {
    ui::mark(ui::Mark::note);
    ui::text(c.news);
  }
  for (const std::string& n : c.notices) {
    ui::mark(ui::Mark::warning);
    ui::text(n, ui::kOrange);
  }
}

StartAnswer draw_start(const StartContent& c, StartMemory& memory, bool back) {
  StartAnswer answer;
  if (back) go_back(memory);
  if (memory.page == StartPage::details && (memory.selected < 0 || memory.selected >= int(c.exercises.size())))
    memory.open(StartPage::exercises);
  ui::begin_screen("start");
  draw_head(c, memory, answer);
  draw_messages(c, answer);
  ImGui::Dummy({0, 2 * ui::scale()});
  const float foot = has_foot(memory.page) ? 38 * ui::scale() : 0, gap = ImGui::GetStyle().ItemSpacing.y;
  ImGui::BeginChild("page", {0, ImGui::GetContentRegionAvail().y - (foot > 0 ? foot + gap : 0)}, false,
                    ImGuiWindowFlags_NavFlattened);
  draw_page(c, memory, answer);
  ImGui::EndChild();
  if (foot > 0) draw_foot(memory, answer, foot);
  ImGui::End();
  return answer;
}

}  // namespace trocar::app
