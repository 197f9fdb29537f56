#include "trainer/result.hpp"

#include <algorithm>
#include <cmath>

#include <imgui.h>

#include <trocar/core/text.hpp>

#include "shell/ui.hpp"

namespace trocar::app {
namespace {

using ui::Mark;

constexpr float kWindow = 900, kLeftShare = 0.58f;  // of the window the left column takes
constexpr float kCurveHeight = 110;

void draw_verdict(const ResultSummary& s, const std::string& mode) {
  using Verdict = ResultSummary::Verdict;
  switch (s.verdict) {
    case Verdict::simulation_failed:
      ui::title(tr("Not assessed: the simulation failed"), ui::kRed);
      ui::text(s.failure, ui::kRed);
      return;
    case Verdict::no_score:
      ui::title(tr("Finished"));
      break;
    case Verdict::ended_early:
      ui::title(tr("Ended early"), ui::kOrange);
      break;
    case Verdict::passed:
    case Verdict::not_passed: {
      const bool passed = s.verdict == Verdict::passed;
      ui::mark(passed ? Mark::done : Mark::warning);
      ui::title(passed ? tr("Passed") : tr("Not passed yet"), passed ? ui::kBlue : ui::kOrange);
    }
  }
  if (!mode.empty()) ui::text(mode, ui::kGrey);
  if (!s.score.empty()) ui::title(s.score);
  ui::text(s.duration, ui::kGrey);
}

/// A bar as long as the share that was reached, its words beside it.
void draw_part(const ResultSummary::Part& part) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float wide = 110 * ui::scale(), high = ImGui::GetTextLineHeight();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(at, {at.x + wide, at.y + high}, IM_COL32(56, 62, 70, 255), 3);
  draw.AddRectFilled(at, {at.x + wide * float(part.share), at.y + high}, ImGui::GetColorU32(ui::kBlue), 3);
  ImGui::Dummy({wide, high});
  ImGui::SameLine();
  ui::text(tr("{}  {}", part.name, part.points));
}

void draw_costs(const ResultSummary& s) {
  if (s.score.empty() && s.costs.empty()) return;
  ui::heading(s.costs.empty() ? tr("No errors") : tr("Errors"));
  for (const ResultSummary::Cost& c : s.costs) {
    ui::mark(c.fails ? Mark::error : Mark::warning);
    ui::text(c.points.empty() ? tr("{} ({})", c.text, c.when) : tr("{} ({}): {}", c.text, c.when, c.points));
    if (c.fails) ui::text(tr("This error fails the attempt."), ui::kRed);
    if (!c.better.empty()) ui::text(c.better, ui::kBlue);
  }
}

void draw_steps(const ResultSummary& s) {
  if (s.steps.empty()) return;
  ui::heading(tr("Steps"));
  for (const ResultSummary::Step& step : s.steps) {
    ui::mark(step.done ? Mark::done : Mark::open);
    ui::text(step.done ? step.name : tr("{} (not completed)", step.name), step.done ? ui::kWhite : ui::kGrey);
  }
}

/// Scores of all attempts from 0 to 100, the pass mark as a line, this attempt as the larger dot.
void draw_curve(const ResultSummary& s) {
  const std::vector<double>& scores = s.standing.scores;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float wide = ImGui::GetContentRegionAvail().x, high = kCurveHeight * ui::scale(), gap = 8 * ui::scale();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(at, {at.x + wide, at.y + high}, IM_COL32(30, 33, 38, 255), 4);
  const auto place = [&](std::size_t i, double score) {
    const float x = scores.size() > 1 ? float(i) / float(scores.size() - 1) : 0.5f;
    return ImVec2{at.x + gap + x * (wide - 2 * gap), at.y + high - gap - float(score) / 100 * (high - 2 * gap)};
  };
  const float mark = place(0, s.pass_mark).y;
  draw.AddLine({at.x, mark}, {at.x + wide, mark}, ImGui::GetColorU32(ui::kOrange));
  draw.AddText({at.x + gap, mark + 1}, ImGui::GetColorU32(ui::kGrey), tr("pass mark"));
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const ImVec2 here = place(i, scores[i]);
    if (i > 0) draw.AddLine(place(i - 1, scores[i - 1]), here, ImGui::GetColorU32(ui::kBlue), 2);
    draw.AddCircleFilled(here, (i + 1 == scores.size() ? 5 : 3) * ui::scale(), ImGui::GetColorU32(ui::kBlue));
  }
  ImGui::Dummy({wide, high});
}

void draw_standing(const ResultSummary& s) {
  if (s.earlier.empty()) return;
  ui::heading(tr("Your attempts at this exercise"));
  draw_curve(s);
  ui::text(s.earlier);
}

void draw_next(const ResultSummary& s) {
  if (s.advice.empty() && s.next.empty()) return;
  ui::heading(tr("What to train next"));
  if (!s.advice.empty()) ui::text(s.advice);
  if (!s.next.empty()) ui::text(s.next);
}

void draw_paths(const ResultSummary& s) {
  if (s.paths.empty()) return;
  ui::heading(tr("Instrument path length"));
  for (const std::string& path : s.paths) ui::text(path, ui::kGrey);
}

void draw_details(const ResultSummary& s) {
  const float most = 0.97f * ImGui::GetIO().DisplaySize.y - 280 * ui::scale();
  const float high = std::floor(std::clamp(most, 60 * ui::scale(), 400 * ui::scale()));
  const float left = kLeftShare * ImGui::GetContentRegionAvail().x;
  ImGui::BeginChild("details", {left, high}, false);
  if (!s.parts.empty()) ui::heading(tr("Points"));
  for (const ResultSummary::Part& part : s.parts) draw_part(part);
  draw_costs(s);
  draw_steps(s);
  ImGui::EndChild();
  ImGui::SameLine();
  ImGui::BeginChild("progress", {0, high}, false);
  draw_next(s);
  draw_standing(s);
  draw_paths(s);
  ImGui::EndChild();
}

Choice draw_actions(const ResultScreen& screen, bool& name_on_report) {
  Choice choice = Choice::none;
  const auto action = [&choice](bool pressed, Choice chosen) {
    if (pressed) choice = chosen;
    ImGui::SameLine();
  };
  const bool restart = ui::button(tr("Restart"), {.width = 130, .height = 32, .primary = true});
  ImGui::SetItemDefaultFocus();
  action(restart, Choice::restart);
  if (screen.recording) action(ui::button(tr("Watch my attempt"), {.width = 180, .height = 32}), Choice::watch);
  if (screen.report) action(ui::button(tr("Open report"), {.width = 140, .height = 32}), Choice::report);
  action(ui::button(tr("Back"), {.width = 110, .height = 32}), Choice::start_screen);
  action(ui::button(tr("Quit"), {.width = 90, .height = 32}), Choice::quit);
  ImGui::NewLine();
  if (screen.report && !screen.trainee.empty())
    ui::checkbox(tr("Print the name \"{}\" on the report", screen.trainee), name_on_report);
  return choice;
}

}  // namespace

Choice draw_result(const ResultScreen& screen, bool& name_on_report) {
  ui::begin_middle("result", kWindow);
  draw_verdict(screen.summary, screen.mode);
  draw_details(screen.summary);
  const Choice choice = draw_actions(screen, name_on_report);
  ui::text(screen.say.empty() ? " " : screen.say, ui::kOrange);  // its line is always there, so that no button moves
  ImGui::End();
  return choice;
}

}  // namespace trocar::app
