#include "player/player_panel.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <trocar/attempt/hand_names.hpp>
#include <trocar/core/tick.hpp>

#include "player/player_keys.hpp"
#include "shell/ui.hpp"

namespace trocar::app {
namespace {

void draw_where(const PlayerPanelContent& c) {
  ui::title(attempt::clock_text(c.now));
  ui::text("of " + attempt::clock_text(c.last), ui::kGrey);
  if (c.exact)
    ui::text("exact: done again from the inputs", ui::kBlue);
  else if (!c.replays || c.differs)
    ui::text("from keyframes, ten a second", ui::kOrange);
  else if (c.way_to_go > core::kTicksPerSecond)
    ui::text(fmt::format("keyframes; {:.1f} s of the recording until exact", double(c.way_to_go) * core::kTick),
             ui::kGrey);
  else
    ui::text("keyframes; the exact picture follows", ui::kGrey);
}

void warn(const std::string& text) {
  ui::mark(ui::Mark::warning);
  ui::text(text, ui::kOrange);
}

/// What keeps this from being the whole recording, exactly.
void draw_caveats(const PlayerPanelContent& c) {
  if (!c.replays && !c.recording.inputs.empty())
    warn("Made with another version of the physics or scene: only its keyframes are shown, nothing is done again.");
  if (!c.recording.damage.empty())
    warn(fmt::format("The file is damaged ({}). Shown is what is sound.", c.recording.damage));
  else if (c.recording.interrupted)
    warn("The attempt was interrupted: it plays up to its last sound second.");
  if (!c.found.difference.empty()) warn(c.found.difference);
  if (c.complete || c.last == 0) return;
  const float share = float(double(c.known_until) / double(c.last));
  ImGui::ProgressBar(share, {-1, 0}, fmt::format("looked through: {:.0f} %", 100 * double(share)).c_str());
}

void draw_guide(const PlayerPanelContent& c) {
  if (c.found.steps.empty()) return ui::text("free practice", ui::kGrey);
  const attempt::GuideState* guide = c.found.guide_at(c.now);
  if (!guide || (!c.complete && c.replays && c.now > c.known_until))
    return ui::text("not looked through yet", ui::kGrey);
  for (std::size_t i = 0; i < c.found.steps.size() && i < guide->done.size(); ++i) {
    const bool done = guide->done[i] == attempt::GuideState::kDone,
               missed = guide->done[i] == attempt::GuideState::kMissed;
    const bool now = int(i) == guide->current && !missed && !done;
    ui::mark(done ? ui::Mark::done : missed ? ui::Mark::warning : now ? ui::Mark::now : ui::Mark::open);
    ui::text(c.found.steps[i].name + (missed ? ", missed" : ""), done || now ? ui::kWhite : ui::kGrey);
    if (now && !c.found.steps[i].hint.empty()) ui::text(c.found.steps[i].hint, ui::kGrey);
  }
}

void draw_errors(const PlayerPanelContent& c) {
  bool any = false;
  for (const attempt::TimelineMark& m : c.found.marks) {
    if (m.kind != attempt::TimelineMark::Kind::error || m.tick > c.now) continue;
    if (!any) ui::heading("Errors until now");
    any = true;
    ui::mark(ui::Mark::error);
    ui::text(fmt::format("{}  {}", attempt::clock_text(m.tick), m.text));
  }
}

void draw_tools(const PlayerPanelContent& c) {
  const sim::Model& model = c.lesson.model;
  for (int h = 0; h < attempt::hand_count(model); ++h) {
    const interactions::ToolState& tool = c.state.tools[std::size_t(h)];
    std::string text =
        attempt::hand_name(model, h) + ": " + attempt::in_words(attempt::held_by(model, c.state, h).name);
    if (tool.holds > 0) text += ", holds";
    const std::string flow = attempt::flow_in_words(c.state, h);
    text += attempt::has_valves(model, c.state, h) ? (flow.empty() ? "" : ", " + flow)
                                                   : fmt::format(", {:.0f} % open", 100 * tool.aperture);
    const double pull = attempt::pull_on(c.state, h);
    if (pull >= 0.05) text += fmt::format(", pull {:.1f} N", pull);
    const double push = attempt::push_at_trocar(model, c.state, h);
    if (push >= 0.05) text += fmt::format(", {:.1f} N at the trocar", push);
    ui::text(text);
  }
  if (const std::string lens = attempt::lens_in_words(c.lesson.model, c.state); !lens.empty())
    ui::text(lens, ui::kOrange);
  for (const std::string& line : attempt::patient_in_words(model, c.state)) ui::text(line, ui::kGrey);
  if (!c.exact) return;  // keyframes have no account
  for (const std::string& line : attempt::fluid_account(model, c.state)) ui::text(line, ui::kGrey);
}

}  // namespace

void draw_player_panel(const PlayerPanelContent& c, float left, float width, float height) {
  ImGui::SetNextWindowPos({left, 0});
  ImGui::SetNextWindowSize({width, height});
  ImGui::SetNextWindowBgAlpha(1);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
  ImGui::Begin("panel", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                   ImGuiWindowFlags_NoBringToFrontOnFocus);
  ui::text(c.lesson.title.empty() ? c.lesson.name : c.lesson.title);
  draw_where(c);
  draw_caveats(c);
  ui::heading("Steps");
  draw_guide(c);
  draw_errors(c);
  ui::heading("Instruments");
  draw_tools(c);
  if (!c.message.empty()) {
    ui::heading("Last");
    ui::text(c.message);
  }
  ui::heading("F1 help   Esc menu");
  ImGui::End();
  ImGui::PopStyleVar();
}

void draw_player_help() {
  ui::begin_middle("player help", 900);
  ui::title("Looking at a recording");
  if (ImGui::BeginTable("keys", 4, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg)) {
    for (const char* head : {"", "keyboard", "mouse", "gamepad"}) ImGui::TableSetupColumn(head);
    ImGui::TableHeadersRow();
    for (const PlayerHelpLine& h : kPlayerHelp) {
      ImGui::TableNextRow();
      for (const char* cell : {h.action, h.keys, h.mouse, h.pad}) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(cell);
      }
    }
    ImGui::EndTable();
  }
  ui::text(
      "On the timeline: a dot is something that happened, a square a step that was done, a triangle an error, a cross "
      "damage. The lighter part has been done again exactly.",
      ui::kGrey);
  ImGui::End();
}

PlayerChoice draw_player_menu() {
  PlayerChoice choice = PlayerChoice::none;
  ui::begin_middle("player menu", 360);
  const auto entry = [&choice](const char* label, PlayerChoice c, bool primary = false) {
    ui::ButtonLook look;
    look.width = 300;
    look.primary = primary;
    if (ui::button(label, look)) choice = c;
  };
  entry("Back to the recording", PlayerChoice::resume, true);
  entry("Save the picture", PlayerChoice::picture);
  entry("Film of the visible time", PlayerChoice::film);
  entry("Display", PlayerChoice::display);
  entry("Views", PlayerChoice::views);
  entry("Keys and buttons", PlayerChoice::help);
  entry("Quit", PlayerChoice::quit);
  ImGui::End();
  return choice;
}

bool draw_film_progress(const std::string& path, double share) {
  ui::begin_middle("film", 520);
  ui::title("Making a film");
  ui::text(path, ui::kGrey);
  ImGui::ProgressBar(float(share), {480 * ui::scale(), 0});
  ui::ButtonLook look;
  look.primary = true;
  const bool cancelled = ui::button("Cancel", look);
  ImGui::End();
  return !cancelled;
}

void draw_waiting(const std::string& what, double share) {
  ui::begin_middle("waiting", 520);
  ui::title(what);
  const double beat = ImGui::GetTime() - double(int(ImGui::GetTime()));  // not known how far: it moves
  ImGui::ProgressBar(float(share >= 0 ? share : beat), {480 * ui::scale(), 0}, share >= 0 ? nullptr : "");
  ImGui::End();
}

}  // namespace trocar::app
