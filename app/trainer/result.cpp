#include "trainer/result.hpp"

#include <fmt/format.h>

#include <trocar/attempt/hand_names.hpp>

#include "shell/ui.hpp"
#include "trainer/feedback.hpp"

namespace trocar::app {
namespace {

using ui::Mark;

void result_line(const Json& from, const char* key, const char* text, const char* format, double factor = 1) {
  if (!from.contains(key) || !from[key].is_number()) return;
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ui::text(text, ui::kGrey);
  ImGui::TableNextColumn();
  ui::text(fmt::format(fmt::runtime(format), factor * from[key].get<double>()));
}

void draw_errors(const Json& errors) {
  ui::heading(errors.empty() ? "No errors" : "Errors");
  for (const Json& e : errors) {
    ui::mark(e.value("fail", false) ? Mark::error : Mark::warning);
    ui::text(fmt::format("{}  {}{}", clock_text(e.value("at_s", e.value("at", 0.0))), e.value("meaning", std::string()),
                         e.contains("points") && e["points"].get<double>() > 0
                             ? fmt::format("  (-{:.0f})", e["points"].get<double>())
                             : std::string()));
  }
}

void draw_assessment(const Json& a) {
  if (ImGui::BeginTable("score", 2)) {
    ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthStretch, 0.3f);
    ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch, 0.7f);
    if (a.contains("score") && a["score"].is_object())
      for (const auto& [key, value] : a["score"].items())
        result_line(a["score"], key.c_str(), attempt::in_words(key).c_str(),
                    key == "total" ? "{:.0f} of 100" : "{:.2f}");
    result_line(a, "exercise_seconds", "time", "{:.0f} s");
    ImGui::EndTable();
  }
  if (a.contains("steps")) {
    ui::heading("Steps");
    for (const Json& s : a["steps"]) {
      const bool done = s.value("done", false);
      ui::mark(done ? Mark::done : Mark::open);
      ui::text(s.value("name", std::string()) + (done ? "" : "  (not done)"), done ? ui::kWhite : ui::kGrey);
    }
  }
  if (a.contains("errors")) draw_errors(a["errors"]);
}

void draw_verdict(const Json& r, const std::string& mode) {
  if (r.contains("failure")) return ui::title("The simulation failed", ui::kRed);
  if (!mode.empty() || r["passed"].is_null()) return ui::title("The end");
  const bool passed = r["passed"].get<bool>();
  if (r.contains("interrupted")) return ui::title("Ended early", ui::kOrange);
  ui::mark(passed ? Mark::done : Mark::warning);
  ui::title(passed ? "Passed" : "Not passed yet", passed ? ui::kBlue : ui::kOrange);
}

}  // namespace

Choice draw_result(const Json& r, const std::string& mode, bool report, const std::string& say) {
  Choice choice = Choice::none;
  ui::begin_middle("result", 680);
  draw_verdict(r, mode);
  if (!mode.empty()) ui::text(mode, ui::kGrey);
  if (r.contains("failure")) ui::text(r["failure"].get<std::string>(), ui::kRed);
  const float most = 0.97f * ImGui::GetIO().DisplaySize.y - 190 * ui::scale();
  ImGui::BeginChild("details", {0, std::clamp(most, 60 * ui::scale(), 380 * ui::scale())}, false);
  if (r.contains("assessment")) draw_assessment(r["assessment"]);
  ui::heading("Ways of the tips");
  for (const Json& hand : r["metrics"]["hands"])  // the same figures as in the report: without the hand's tremor
    if (hand["path_m"].is_number())
      ui::text(fmt::format("{}: {:.0f} mm", attempt::in_words(hand["name"].get<std::string>()),
                           1000 * hand["path_m"].get<double>()),
               ui::kGrey);
  if (r.contains("recording")) ui::text("recorded in " + r["recording"].get<std::string>(), ui::kGrey);
  ImGui::EndChild();
  if (!say.empty()) ui::text(say, ui::kGrey);
  if (ui::button("Again", {.width = 140, .height = 32, .primary = true})) choice = Choice::restart;
  ImGui::SetItemDefaultFocus();
  ImGui::SameLine();
  if (report) {
    if (ui::button("Open the report", {.width = 160, .height = 32})) choice = Choice::report;
    ImGui::SameLine();
  }
  if (ui::button("Start screen", {.width = 140, .height = 32})) choice = Choice::start_screen;
  ImGui::SameLine();
  if (ui::button("Quit", {.width = 90, .height = 32})) choice = Choice::quit;
  ImGui::End();
  return choice;
}

}  // namespace trocar::app
