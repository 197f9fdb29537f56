#include "player/player_panel.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <trocar/attempt/hand_names.hpp>
#include <trocar/core/text.hpp>
#include <trocar/core/tick.hpp>

#include "player/player_keys.hpp"
#include "shell/ui.hpp"

namespace trocar::app {
namespace {

void draw_where(const PlayerPanelContent& c) {
  ui::title(attempt::clock_text(c.now));
  ui::text(tr("of {}", attempt::clock_text(c.last)), ui::kGrey);
  if (c.exact)
    ui::text(tr("Exact replay"), ui::kBlue);
  else if (!c.replays || c.differs)
    ui::text(tr("Keyframes, 10 per second"), ui::kOrange);
  else if (c.way_to_go > core::kTicksPerSecond)
    ui::text(tr("Keyframes; exact replay in {:.1f} s of the recording", double(c.way_to_go) * core::kTick), ui::kGrey);
  else
    ui::text(tr("Keyframes; the exact picture follows"), ui::kGrey);
}

void warn(const std::string& text) {
  ui::mark(ui::Mark::warning);
  ui::text(text, ui::kOrange);
}

/// What keeps this from being the whole recording, exactly.
void draw_caveats(const PlayerPanelContent& c) {
  if (!c.replays && !c.recording.inputs.empty())
    warn(tr("Recorded with another version of the physics or scene: only its keyframes can be shown."));
  if (!c.recording.damage.empty())
    warn(tr("The file is damaged ({}). Only the undamaged part is shown.", c.recording.damage));
  else if (c.recording.interrupted)
    warn(tr("The attempt was interrupted. The recording ends early."));
  if (!c.found.difference.empty()) warn(c.found.difference);
  if (c.complete || c.last == 0) return;
  const float share = float(double(c.known_until) / double(c.last));
  ImGui::ProgressBar(share, {-1, 0}, tr("Loading {:.0f} %", 100 * double(share)).c_str());
}

void draw_guide(const PlayerPanelContent& c) {
  if (c.found.steps.empty()) return ui::text(tr("Free practice"), ui::kGrey);
  const attempt::GuideState* guide = c.found.guide_at(c.now);
  if (!guide || (!c.complete && c.replays && c.now > c.known_until)) return ui::text(tr("Still loading"), ui::kGrey);
  for (std::size_t i = 0; i < c.found.steps.size() && i < guide->done.size(); ++i) {
    const bool done = guide->done[i] == attempt::GuideState::kDone,
               missed = guide->done[i] == attempt::GuideState::kMissed;
    const bool now = int(i) == guide->current && !missed && !done;
    ui::mark(done ? ui::Mark::done : missed ? ui::Mark::warning : now ? ui::Mark::now : ui::Mark::open);
    ui::text(missed ? tr("{} (missed)", c.found.steps[i].name) : c.found.steps[i].name,
             done || now ? ui::kWhite : ui::kGrey);
    if (now && !c.found.steps[i].hint.empty()) ui::text(c.found.steps[i].hint, ui::kGrey);
  }
}

void draw_errors(const PlayerPanelContent& c) {
  bool any = false;
  for (const attempt::TimelineMark& m : c.found.marks) {
    if (m.kind != attempt::TimelineMark::Kind::error || m.tick > c.now) continue;
    if (!any) ui::heading(tr("Errors so far"));
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
    if (tool.holds > 0) text += tr(", grasping");
    const std::string flow = attempt::flow_in_words(c.state, h);
    text += attempt::has_valves(model, c.state, h) ? (flow.empty() ? "" : ", " + flow)
                                                   : tr(", {:.0f} % open", 100 * tool.aperture);
    const double pull = attempt::pull_on(c.state, h);
    if (pull >= 0.05) text += tr(", pull {:.1f} N", pull);
    const double push = attempt::push_at_trocar(model, c.state, h);
    if (push >= 0.05) text += tr(", {:.1f} N at the trocar", push);
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
  ui::heading(tr("Steps"));
  draw_guide(c);
  draw_errors(c);
  if (attempt::hand_count(c.lesson.model) > 0) ui::heading(tr("Instruments"));
  draw_tools(c);
  if (!c.message.empty()) {
    ui::heading(tr("Last action"));
    ui::text(c.message);
  }
  ui::heading(tr("F1 help   Esc menu"));
  ImGui::End();
  ImGui::PopStyleVar();
}

void draw_caption(const attempt::Caption& caption, const std::string& note, const Area& area) {
  if (caption == attempt::Caption{} && note.empty()) return;
  constexpr float kShare = 0.8f;  // of the picture's width
  ImGui::SetNextWindowPos({area.x + 0.5f * area.width, area.y + area.height - 10 * ui::scale()}, ImGuiCond_Always,
                          {0.5f, 1});
  ImGui::SetNextWindowSizeConstraints({kShare * area.width, 0}, {kShare * area.width, 0.5f * area.height});
  ImGui::SetNextWindowBgAlpha(0.72f);
  ImGui::Begin("caption", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing |
                   ImGuiWindowFlags_NoBringToFrontOnFocus);
  if (!note.empty()) ui::text(note, ui::kOrange);
  if (!caption.step.empty()) ui::text(caption.step, ui::kBlue);
  if (!caption.hint.empty()) ui::text(caption.hint);
  if (!caption.doing.empty()) ui::text(caption.doing, ui::kGrey);
  ImGui::End();
}

void draw_player_help() {
  ui::begin_middle("player help", 900);
  ui::title(tr("Player: keys and buttons"));
  if (ImGui::BeginTable("keys", 4, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg)) {
    for (const char* head : {"", tr("Keyboard"), tr("Mouse"), tr("Gamepad")}) ImGui::TableSetupColumn(head);
    ImGui::TableHeadersRow();
    for (const PlayerHelpLine& h : kPlayerHelp) {
      ImGui::TableNextRow();
      for (const char* cell : {h.action, h.keys, h.mouse, h.pad}) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(*cell ? tr(cell) : cell);
      }
    }
    ImGui::EndTable();
  }
  ui::text(tr("On the timeline, a dot marks an event, a square a completed step, a triangle an error, a cross damage. "
              "The lighter "
              "part has been replayed exactly."),
           ui::kGrey);
  ImGui::End();
}

PlayerChoice draw_player_menu(const PlayerOptions& options) {
  PlayerChoice choice = PlayerChoice::none;
  ui::begin_middle("player menu", 360);
  const auto entry = [&choice](const char* label, PlayerChoice c, bool primary = false) {
    ui::ButtonLook look;
    look.width = 300;
    look.primary = primary;
    if (ui::button(label, look)) choice = c;
  };
  entry(tr("Resume"), PlayerChoice::resume, true);
  if (options.now_you) entry(tr("Now you"), PlayerChoice::now_you);
  entry(tr("Save picture"), PlayerChoice::picture);
  entry(tr("Export this section as video"), PlayerChoice::film);
  entry(tr("Display"), PlayerChoice::display);
  entry(tr("Views"), PlayerChoice::views);
  entry(tr("Keys and buttons"), PlayerChoice::help);
  entry(options.inside ? tr("Back") : tr("Quit"), PlayerChoice::quit);
  ImGui::End();
  return choice;
}

bool draw_film_progress(const std::string& path, double share) {
  ui::begin_middle("film", 520);
  ui::title(tr("Exporting the video"));
  ui::text(path, ui::kGrey);
  ImGui::ProgressBar(float(share), {480 * ui::scale(), 0});
  ui::ButtonLook look;
  look.primary = true;
  const bool cancelled = ui::button(tr("Cancel"), look);
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
