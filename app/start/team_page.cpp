// Several people at one exercise over the network: one hosts, the others join.
#include <algorithm>
#include <cstring>
#include <random>

#include <trocar/core/text.hpp>

#include "shell/ui.hpp"
#include "start/catalogue.hpp"
#include "start/pages.hpp"

namespace trocar::app {
namespace {

constexpr const char* kRoles[] = {"camera", "assistant", "left", "right"};
constexpr const char* kKeyVariable = "TROCAR_TOKEN";

const char* title_of_role(int role) {
  const char* titles[] = {tr("Camera"), tr("Assistant"), tr("Left hand"), tr("Right hand")};
  return titles[role];
}

void draw_key_of_host(TeamForm& form) {
  if (form.key[0]) return;
  std::random_device random;
  for (int i = 0; i < 20; ++i) form.key[i] = "abcdefghijkmnpqrstuvwxyz23456789"[random() % 32];
}

void role_box(const char* id, int& role) {
  ImGui::SetNextItemWidth(170 * ui::scale());
  if (ImGui::BeginCombo(id, title_of_role(role))) {
    for (int i = 0; i < int(std::size(kRoles)); ++i)
      if (ImGui::Selectable(title_of_role(i), i == role)) role = i;
    ImGui::EndCombo();
  }
  ui::note_widget(id);
}

void exercise_box(const StartContent& c, TeamForm& form) {
  form.exercise = std::clamp(form.exercise, 0, int(c.exercises.size()) - 1);
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##team exercise", title_of(c.exercises[std::size_t(form.exercise)]).c_str())) {
    for (int i = 0; i < int(c.exercises.size()); ++i)
      if (ImGui::Selectable(title_of(c.exercises[std::size_t(i)]).c_str(), i == form.exercise)) form.exercise = i;
    ImGui::EndCombo();
  }
  ui::note_widget("team exercise");
}

void field(const char* title, const char* id, char* text, std::size_t size, float width) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(title);
  ImGui::SameLine(90 * ui::scale());
  ImGui::SetNextItemWidth(width * ui::scale());
  ImGui::InputText(id, text, size);
  ui::note_widget(id);
}

void draw_host(const StartContent& c, StartMemory& memory, StartAnswer& answer) {
  TeamForm& form = memory.team;
  draw_key_of_host(form);
  ui::text(tr("Host"), ui::kBlue);
  ui::text(tr("You operate. One more person controls the camera or a hand from another computer."), ui::kGrey);
  exercise_box(c, form);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(tr("Other role"));
  ImGui::SameLine(90 * ui::scale());
  role_box("##host role", form.role);
  field(tr("Address"), "##host address", form.address, sizeof form.address, 170);
  field(tr("Port"), "##host port", form.port, sizeof form.port, 80);
  field(tr("Key"), "##host key", form.key, sizeof form.key, 230);
  ui::beside(80);
  if (ui::button(tr("Copy") + std::string("##key"), {.width = 80})) ImGui::SetClipboardText(form.key);
  ui::text(tr("0.0.0.0: other computers may join. 127.0.0.1: only this one. Give the other person this computer's "
              "address, the port and the key."),
           ui::kGrey);
  const attempt::ExerciseEntry& e = c.exercises[std::size_t(form.exercise)];
  if (ui::button(tr("Host the exercise"), {.width = 220, .height = 36, .primary = true})) {
    const std::string place = std::string(form.address) + ":" + form.port;
    answer.program = {tr("The team exercise"),
                      {"train", e.name, "--team", kRoles[form.role], "--team-at", place},
                      {std::string(kKeyVariable) + "=" + form.key}};
    if (!c.person.empty()) answer.program.arguments.insert(answer.program.arguments.end(), {"--trainee", c.person});
  }
  first_focus(memory);
}

void draw_join(StartMemory& memory, StartAnswer& answer) {
  TeamForm& form = memory.team;
  ui::text(tr("Join"), ui::kBlue);
  ui::text(tr("Somebody else hosts. Enter the address, port and key that the host gives you."), ui::kGrey);
  field(tr("Address"), "##join address", form.join_address, sizeof form.join_address, 170);
  field(tr("Port"), "##join port", form.join_port, sizeof form.join_port, 80);
  field(tr("Key"), "##join key", form.join_key, sizeof form.join_key, 230);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(tr("Your role"));
  ImGui::SameLine(90 * ui::scale());
  role_box("##join role", form.join_role);
  const bool whole = form.join_address[0] && form.join_port[0] && form.join_key[0];
  if (ui::button(tr("Join the exercise"), {.width = 220, .height = 36, .primary = true, .enabled = whole}))
    answer.program = {tr("The shared exercise"),
                      {"join", std::string(form.join_address) + ":" + form.join_port, "--role", kRoles[form.join_role]},
                      {std::string(kKeyVariable) + "=" + form.join_key}};
  if (!whole) ui::text(tr("Address, port and key are needed."), ui::kGrey);
}

}  // namespace

void draw_team_page(const StartContent& c, StartMemory& memory, StartAnswer& answer) {
  ui::title(tr("Team"));
  if (c.exercises.empty()) return;
  const ImVec2 room = ImGui::GetContentRegionAvail();
  ImGui::BeginChild("host", {0.5f * room.x - 6 * ui::scale(), 0}, false,
                    ImGuiWindowFlags_NavFlattened | ImGuiWindowFlags_AlwaysUseWindowPadding);
  draw_host(c, memory, answer);
  ImGui::EndChild();
  ImGui::SameLine();
  ImGui::BeginChild("join", {0, 0}, false, ImGuiWindowFlags_NavFlattened | ImGuiWindowFlags_AlwaysUseWindowPadding);
  draw_join(memory, answer);
  ImGui::EndChild();
}

}  // namespace trocar::app
