#include <algorithm>
#include <random>

#include <trocar/core/text.hpp>

#include "shell/ui.hpp"
#include "start/catalogue.hpp"
#include "start/pages.hpp"

namespace trocar::app {
namespace {

using ui::Mark;

constexpr float kButtons = 104;  // [px at scale 1] of the row of buttons and what is said below it

void draw_exercise_picture(const StartContent& c, unsigned texture, float height) {
  const float room = ImGui::GetContentRegionAvail().x;
  const float width = std::min(room, height * c.facts.aspect), tall = width / c.facts.aspect;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 low{at.x + 0.5f * (room - width), at.y}, high{low.x + width, at.y + tall};
  draw.AddRectFilled(at, {at.x + room, at.y + tall}, ImGui::GetColorU32({0, 0, 0, 1}), 4);
  if (texture != 0) {
    draw.AddImage(reinterpret_cast<ImTextureID>(std::uintptr_t(texture)), low, high);
  } else {
    const std::string words = c.failure.empty() ? tr("Preparing the picture ...") : tr("No picture");
    const ImVec2 size = ImGui::CalcTextSize(words.c_str());
    draw.AddText({at.x + 0.5f * (room - size.x), at.y + 0.5f * (tall - size.y)}, ImGui::GetColorU32(ui::kGrey),
                 words.c_str());
  }
  ImGui::Dummy({room, tall});
}

void draw_results_of(const StartContent& c, const attempt::ExerciseEntry& e) {
  const auto found = c.past.standings.find(e.name);
  if (found == c.past.standings.end()) {
    ui::text(tr("You have not done this exercise yet."), ui::kGrey);
    return;
  }
  const Standing& s = found->second;
  ui::mark(s.passed ? Mark::done : Mark::open);
  ui::text(
      tr("Your best: {:.0f} of 100. Last: {:.0f}. Attempts: {}.", s.best.value_or(0), s.last.value_or(0), s.attempts));
}

void draw_facts(const StartContent& c, const attempt::ExerciseEntry& e) {
  if (!e.task) {
    ui::text(tr("Free practice: no task, no clock, no score. A recording is kept."), ui::kGrey);
    return;
  }
  ui::text(tr("{}, {}. Pass mark: {:.0f} of 100.", title_of_level(e.level), duration_text(e.expert_time), e.pass_mark),
           ui::kGrey);
  draw_results_of(c, e);
}

void draw_steps(const StartContent& c, const attempt::ExerciseEntry& e, float height) {
  if (!e.task) return;
  ui::text(tr("Steps"), ui::kBlue);
  ImGui::BeginChild("steps", {0, std::max(40 * ui::scale(), height - ImGui::GetTextLineHeightWithSpacing())}, false,
                    ImGuiWindowFlags_NavFlattened);
  if (c.facts.steps.empty() && c.failure.empty()) ui::text(tr("Preparing ..."), ui::kGrey);
  for (const std::string& step : c.facts.steps) {
    ui::mark(Mark::note);
    ui::text(step);
  }
  ImGui::EndChild();
}

/// Whose anatomy: the same number brings the same patient back.
void draw_patient(StartMemory& memory) {
  ui::text(tr("Patient"), ui::kBlue);
  const float gap = ImGui::GetStyle().ItemSpacing.x, number = 96;
  const float width = 0.5f * (ImGui::GetContentRegionAvail().x - 2 * gap) / ui::scale() - 0.5f * number;
  if (ui::button(tr("Standard patient"), {.width = width, .height = 30, .primary = memory.seed == 0})) memory.seed = 0;
  ImGui::SameLine();
  if (ui::button(tr("Random patient"), {.width = width,
                                        .height = 30,
                                        .primary = memory.seed != 0,
                                        .tip = tr("Different anatomy and bleeding site. The number brings this patient "
                                                  "back.")}))
    memory.seed = 1 + std::random_device{}() % kMostAnatomies;
  ImGui::SameLine();
  ImGui::SetNextItemWidth(number * ui::scale());
  int shown = int(memory.seed);
  if (ImGui::InputInt("##patient", &shown, 0, 0, ImGuiInputTextFlags_EnterReturnsTrue))
    memory.seed = std::uint64_t(std::clamp(shown, 0, int(kMostAnatomies)));
  ui::note_widget("patient number");
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tr("Number of the patient; 0 is the standard patient"));
}

/// Why a button cannot be pressed, or what pressing it means.
std::string explained(const StartContent& c, const attempt::ExerciseEntry& e) {
  if (!c.failure.empty()) return "";
  if (!c.ready) return tr("The exercise is being prepared. This takes some seconds.");
  if (!e.task) return tr("Free practice has no task: there is nothing to familiarise with or to demonstrate.");
  if (!e.demonstrated) return tr("This exercise has no demonstration. Familiarise: no clock, no score.");
  return tr("Start: with clock and score. Familiarise: without. Demonstration: watch how it is done.");
}

void draw_start_buttons(const StartContent& c, const attempt::ExerciseEntry& e, StartMemory& memory,
                        StartAnswer& answer) {
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const float unit = (ImGui::GetContentRegionAvail().x - 2 * gap) / 3 / ui::scale();
  const auto choose = [&answer](bool pressed, StartChoice choice) {
    if (pressed) answer.choice = choice;
  };
  choose(ui::button(tr("Start"), {.width = unit, .height = 44, .primary = true, .enabled = c.ready}),
         StartChoice::start);
  if (c.ready && !memory.was_ready && !ImGui::GetIO().WantTextInput) ui::take_focus();
  memory.was_ready = c.ready;
  ImGui::SameLine();
  choose(ui::button(tr("Familiarise"), {.width = unit, .height = 44, .enabled = c.ready && e.task}),
         StartChoice::familiarise);
  ImGui::SameLine();
  choose(ui::button(tr("Demonstration"), {.width = unit, .height = 44, .enabled = c.ready && e.task && e.demonstrated}),
         StartChoice::demonstrate);
  ui::text(explained(c, e), ui::kGrey);
}

}  // namespace

void draw_details_page(const StartContent& c, StartMemory& memory, StartAnswer& answer) {
  const attempt::ExerciseEntry& e = c.exercises[std::size_t(memory.selected)];
  const ImVec2 room = ImGui::GetContentRegionAvail();
  ImGui::BeginChild("picture", {0.5f * room.x, 0}, false, ImGuiWindowFlags_NavFlattened);
  const unsigned texture = c.facts.picture != 0 ? c.facts.picture : c.thumbnail(memory.selected);
  draw_exercise_picture(c, texture, 0.68f * room.y);
  ImGui::Dummy({0, 4 * ui::scale()});
  ui::text(e.summary);
  ImGui::EndChild();
  ImGui::SameLine(0, 14 * ui::scale());
  ImGui::BeginChild("choices", {0, 0}, false, ImGuiWindowFlags_NavFlattened);
  ui::title(title_of(e));
  draw_facts(c, e);
  if (!c.failure.empty()) {
    ui::mark(Mark::error);
    ui::text(c.failure, ui::kRed);
  }
  ImGui::Dummy({0, 2 * ui::scale()});
  const float patient = 62 * ui::scale(), explanation = kButtons * ui::scale();
  draw_steps(c, e, ImGui::GetContentRegionAvail().y - patient - explanation);
  if (!e.task) ImGui::Dummy({0, ImGui::GetContentRegionAvail().y - patient - explanation});
  draw_patient(memory);
  draw_start_buttons(c, e, memory, answer);
  ImGui::EndChild();
}

}  // namespace trocar::app
