#include "shell/layout_panel.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <imgui.h>

#include <trocar/core/text.hpp>
#include <trocar/pictures/analysis_choice.hpp>
#include <trocar/pictures/camera_choice.hpp>

#include "shell/ui.hpp"

namespace trocar::app {
namespace {

constexpr double kTurn = 0.15, kStep = 0.15;  // [rad], of the distance, a press

/// A row of buttons, one of them lit; the number of the one that was pressed, -1: none.
template <std::size_t n>
int draw_choice(const char* id, const LayoutName (&names)[n], int lit) {
  int pressed = -1;
  ImGui::PushID(id);
  for (std::size_t i = 0; i < n; ++i) {
    if (i > 0) ImGui::SameLine(0, 3 * ui::scale());
    const std::string label = fmt::format("{}##{}", names[i].name, id);
    if (ui::button(label, {.width = 124, .height = 26, .primary = int(i) == lit, .tip = names[i].meaning}))
      pressed = int(i);
  }
  ImGui::PopID();
  return pressed;
}

void draw_panes(LayoutChoice& choice) {
  constexpr const char* kPlaces[kMostPanes] = {"first", "second", "third", "fourth"};
  for (int i = 0; i < choice.count(); ++i) {
    const int pressed = draw_choice(kPlaces[i], kPaneNames, int(choice.panes[std::size_t(i)]));
    if (pressed >= 0) choice.put(i, PaneShows(pressed));
    ImGui::SameLine();
    ui::text(kPlaces[i], ui::kGrey);
  }
}

void draw_second_window(LayoutChoice& choice) {
  ui::text("Second window (F3), for a second screen", ui::kBlue);
  if (ui::button("off##second window", {.width = 70, .height = 26, .primary = !choice.elsewhere}))
    choice.elsewhere.reset();
  ImGui::SameLine(0, 3 * ui::scale());
  const int pressed = draw_choice("second window", kPaneNames, choice.elsewhere ? int(*choice.elsewhere) : -1);
  if (pressed >= 0) choice.elsewhere = PaneShows(pressed);
}

void draw_analysis(Panes& panes) {
  ui::text("Analysis", ui::kBlue);
  bool first = true;
  for (const pictures::AnalysisQuantity& q : pictures::kAnalysisQuantities) {
    if (!first) ImGui::SameLine(0, 14 * ui::scale());
    first = false;
    ui::checkbox(q.name, panes.cameras.analysis.*q.shown);
  }
  if (panes.beside) {
    ImGui::SameLine(0, 14 * ui::scale());
    ui::checkbox("solvers", panes.cameras.analysis.solvers);
  }
  ImGui::SameLine(0, 14 * ui::scale());
  ui::checkbox("through the endoscope", panes.cameras.analysis_from_endoscope);
}

/// What dragging does, step by step.
void draw_camera(const char* name, PaneShows shows, Panes& panes) {
  ImGui::PushID(name);
  ImGui::PushButtonRepeat(true);
  const auto step = [&](const char* label) {
    const bool pressed = ui::button(fmt::format("{}##{}", tr(label), name), {.width = 70, .height = 26});
    ImGui::SameLine(0, 3 * ui::scale());
    return pressed;
  };
  // An endoscope looks to where the button says, a camera goes there.
  if (step("left")) panes.turn(shows, -kTurn, 0);
  if (step("right")) panes.turn(shows, kTurn, 0);
  if (step("up")) panes.turn(shows, 0, kTurn);
  if (step("down")) panes.turn(shows, 0, -kTurn);
  if (step("nearer")) panes.closer(shows, kStep);
  if (step("further")) panes.closer(shows, -kStep);
  ImGui::PopButtonRepeat();
  ui::text(name, ui::kGrey);
  ImGui::PopID();
}

}  // namespace

bool draw_layout_panel(LayoutChoice& choice, Panes& panes) {
  ui::begin_middle("views", 720);
  ui::title("Views");
  const int layout = draw_choice("layout", kLayoutNames, int(choice.layout));
  if (layout >= 0) choice.layout = Layout(layout);
  ui::text("Panes", ui::kBlue);
  draw_panes(choice);
  draw_second_window(choice);
  const bool figures = choice.shows(PaneShows::analysis) || choice.elsewhere == PaneShows::analysis;
  if (figures) draw_analysis(panes);
  const auto turns = [&choice](PaneShows shows) { return choice.shows(shows) || choice.elsewhere == shows; };
  const bool cameras = turns(PaneShows::outside) || turns(PaneShows::analysis) || turns(PaneShows::second_scope);
  if (cameras) ui::text("Cameras (or drag in the pane; right drag shifts, the wheel comes nearer)", ui::kBlue);
  if (turns(PaneShows::outside)) draw_camera("outside", PaneShows::outside, panes);
  if (turns(PaneShows::analysis) && !panes.cameras.analysis_from_endoscope)
    draw_camera("analysis", PaneShows::analysis, panes);
  if (turns(PaneShows::second_scope)) draw_camera("second scope", PaneShows::second_scope, panes);
  const bool closed = ui::button("Close", {.width = 130, .primary = true});
  ImGui::SetItemDefaultFocus();
  ImGui::End();
  return closed;
}

}  // namespace trocar::app
