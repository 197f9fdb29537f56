#include <algorithm>
#include <cctype>
#include <cstring>

#include <trocar/core/letters.hpp>
#include <trocar/core/text.hpp>

#include "shell/ui.hpp"
#include "start/pages.hpp"

namespace trocar::app {
namespace {

void set_name(StartMemory& memory, const std::string& name) {
  std::memset(memory.name, 0, sizeof memory.name);
  std::memcpy(memory.name, name.data(), std::min(name.size(), sizeof memory.name - 1));
}

/// Removes a whole character of UTF-8.
void remove_last(std::string& name) {
  if (name.empty()) return;
  char last;
  do last = name.back(), name.pop_back();
  while (!name.empty() && (static_cast<unsigned char>(last) & 0xC0) == 0x80);
}

/// Letters for those who have no keyboard at hand.
void draw_letters(StartMemory& memory) {
  std::string name = memory.name;
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789 ";
  const float gap = 4 * ui::scale(), size = 28 * ui::scale();
  const int row = std::max(6, int((ImGui::GetContentRegionAvail().x + gap) / (size + gap)));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {gap, gap});
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, 3 * ui::scale()});
  int count = 0;
  const auto key = [&](const char* label) {
    if (count++ % row != 0) ImGui::SameLine();
    const bool pressed = ImGui::Button(label, {size, 0});
    ui::note_widget(std::string("letter ") + label);
    return pressed;
  };
  for (const char letter : letters) {
    const char label[] = {letter == ' ' ? '_' : letter, 0};
    if (!key(label) || name.size() >= training::kLongestName) continue;
    const bool first = name.empty() || name.back() == ' ';
    name += first ? letter : core::small_letter(letter);
  }
  if (key("<")) remove_last(name);
  ImGui::PopStyleVar(2);
  if (name != memory.name) set_name(memory, name);
}

/// Who is known under this name, however it is written; else the name itself.
std::string known_as(const std::string& name, const std::vector<std::string>& people) {
  for (const std::string& known : people)
    if (core::in_small_letters(known) == core::in_small_letters(name)) return known;
  return name;
}

void add_person(const StartContent& c, StartMemory& memory, StartAnswer& answer) {
  const std::string name = training::clean_name(memory.name);
  memory.refusal.clear();
  if (name.empty())
    memory.refusal = tr("Type a name first.");
  else if (is_reserved_name(core::in_small_letters(name)))
    memory.refusal = tr("Trocar uses this name itself. Choose another name.");
  else
    answer.person = known_as(name, c.people);
}

void draw_adding(const StartContent& c, StartMemory& memory, StartAnswer& answer) {
  ui::text(tr("Add a person"), ui::kBlue);
  const float letters = 60, add = 110, gap = ImGui::GetStyle().ItemSpacing.x;
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - (letters + add) * ui::scale() - 2 * gap);
  const bool entered = ImGui::InputTextWithHint("##name", tr("Name"), memory.name, sizeof memory.name,
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  ui::note_widget("Name");
  if (c.people.empty()) first_focus(memory);
  ImGui::SameLine();
  if (ui::button("abc", {.width = letters, .tip = tr("On-screen keyboard")})) memory.letters ^= true;
  ImGui::SameLine();
  if (ui::button(tr("Add"), {.width = add, .primary = true}) || entered) add_person(c, memory, answer);
  if (!memory.refusal.empty()) ui::text(memory.refusal, ui::kOrange);
  if (memory.letters) draw_letters(memory);
}

void draw_people(const StartContent& c, StartMemory& memory, StartAnswer& answer, float height) {
  constexpr int kColumns = 3;
  ImGui::BeginChild("people", {0, height}, false, ImGuiWindowFlags_NavFlattened);
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const float width = (ImGui::GetContentRegionAvail().x - (kColumns - 1) * gap) / kColumns / ui::scale();
  for (std::size_t i = 0; i < c.people.size(); ++i) {
    if (i % kColumns != 0) ImGui::SameLine();
    const bool last = i == 0;
    if (ui::button(c.people[i] + "##person", {.width = width, .height = 44, .primary = last}))
      answer.person = c.people[i];
    if (last) first_focus(memory);
  }
  ImGui::EndChild();
}

float people_height(const StartContent& c, const StartMemory& memory) {
  const float row = 50 * ui::scale(), below = (memory.letters ? 320 : 210) * ui::scale();
  const float wanted = row * float((c.people.size() + 2) / 3);
  return std::max(row, std::min(wanted, ImGui::GetContentRegionAvail().y - below));
}

}  // namespace

void draw_person_page(const StartContent& c, StartMemory& memory, StartAnswer& answer) {
  const float room = ImGui::GetContentRegionAvail().x, width = std::min(room, 760 * ui::scale());
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 0.5f * (room - width));
  ImGui::BeginChild("middle", {width, 0}, false, ImGuiWindowFlags_NavFlattened);
  ImGui::Dummy({0, 10 * ui::scale()});
  ui::title(tr("Who is practising?"));
  ui::text(tr("Results, recordings and settings are kept for each person."), ui::kGrey);
  ImGui::Dummy({0, 6 * ui::scale()});
  if (!c.people.empty()) draw_people(c, memory, answer, people_height(c, memory));
  ImGui::Dummy({0, 6 * ui::scale()});
  draw_adding(c, memory, answer);
  ImGui::Dummy({0, 10 * ui::scale()});
  if (ui::button(tr("Practise without a name"), {.width = 260, .height = 34})) answer.person = "";
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  ui::text(tr("Results are kept under \"{}\".", kNameless), ui::kGrey);
  ImGui::EndChild();
}

}  // namespace trocar::app
