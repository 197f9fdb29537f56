#include "panel.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

namespace trocar::app {
namespace {

const ImVec4 kAmber{1.0f, 0.72f, 0.25f, 1}, kGreen{0.45f, 0.85f, 0.5f, 1}, kRed{1.0f, 0.42f, 0.38f, 1},
    kGrey{0.62f, 0.64f, 0.67f, 1}, kWhite{0.95f, 0.95f, 0.95f, 1};

void line(const std::string& text) { ImGui::TextUnformatted(text.c_str()); }
void line(const ImVec4& colour, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

/// "clip_applier" -> "clip applier"
std::string words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

void draw_time(const PanelContent& c) {
  const int whole = int(c.now.seconds);
  ImGui::SetWindowFontScale(1.7f);
  line(fmt::format("{}:{:02}", whole / 60, whole % 60));
  ImGui::SetWindowFontScale(1);
  if (c.paused)
    line(kAmber, "paused");
  else if (c.now.speed < 0.97)
    line(kAmber, fmt::format("x{:.2f} slow motion", c.now.speed));
  else
    line(kGrey, "real time");
}

void draw_instruments(const PanelContent& c) {
  const sim::Model& model = c.lesson.model;
  for (std::size_t t = 0; t < model.tools.size(); ++t) {
    const interactions::ToolState& tool = c.now.state.tools[t];
    const bool led = c.hands && c.hands->led == int(t);
    std::string text = fmt::format("{} {} {}", led ? ">" : " ", t + 1, words(model.tools[t].name));
    if (model.tools[t].clips > 0) text += fmt::format(", {} clips", tool.clips_left);
    if (tool.holds > 0) text += ", holds";
    if (c.hands && c.hands->ratchet[t]) text += ", ratchet";
    line(led ? kGreen : kWhite, text);
  }
  if (!c.hands) return line(kGrey, "led by " + c.input);
  const bool scope = c.hands->led == devices::kScope;
  line(scope ? kGreen : kWhite, fmt::format("{} 0 endoscope", scope ? ">" : " "));
}

/// The pull on the led instrument; beyond the exercise's limit the bar is red.
void draw_pull(const PanelContent& c, float scale) {
  double pull = 0;
  const std::size_t tools = c.lesson.model.tools.size();
  for (std::size_t t = 0; t < tools; ++t) {
    const double(&f)[3] = c.now.state.tools[t].pull;
    pull = std::max(pull, length(Vec3d{f[0], f[1], f[2]}));
  }
  const double limit = c.lesson.exercise ? c.lesson.exercise->goal.pull_limit : 5.0;
  const ImVec4 colour = pull > limit ? kRed : pull > 0.5 * limit ? kAmber : kGreen;
  line(kGrey, fmt::format("pull (limit {:.0f} N)", limit));
  ImGui::PushStyleColor(ImGuiCol_PlotHistogram, colour);
  ImGui::ProgressBar(float(std::min(1.0, pull / (1.25 * limit))), {-1, 18 * scale},
                     fmt::format("{:.1f} N", pull).c_str());
  ImGui::PopStyleColor();
}

void draw_guide(const PanelContent& c) {
  if (c.steps.empty()) return line(kGrey, "free practice");
  for (std::size_t i = 0; i < c.steps.size(); ++i) {
    const bool done = i < c.now.step_done.size() && c.now.step_done[i];
    const bool current = int(i) == c.now.current_step;
    line(done ? kGreen : current ? kWhite : kGrey, fmt::format("{} {}", done ? "[x]" : "[ ]", c.steps[i].name));
    if (current && !done) line(kGrey, c.steps[i].hint);
  }
}

void heading(const char* text) {
  ImGui::Dummy({0, ImGui::GetStyle().ItemSpacing.y});
  ImGui::Separator();
  line(kGrey, text);
}

/// A panel in the middle of the window.
void begin_middle(const char* name, float width) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * size.x, 0.5f * size.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {std::min(width, size.x), 0.95f * size.y});
  ImGui::SetNextWindowBgAlpha(0.92f);
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings);
}

bool button(const char* text, float scale) { return ImGui::Button(text, {200 * scale, 32 * scale}); }

}  // namespace

void draw_panel(const PanelContent& c, float left, float width, float height, float scale) {
  ImGui::SetNextWindowPos({left, 0});
  ImGui::SetNextWindowSize({width, height});
  ImGui::SetNextWindowBgAlpha(1);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
  ImGui::Begin("panel", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus);
  line(kWhite, c.lesson.title.empty() ? c.lesson.name : c.lesson.title);
  draw_time(c);
  heading("Instruments");
  draw_instruments(c);
  ImGui::Dummy({0, 4 * scale});
  draw_pull(c, scale);
  heading("Steps");
  draw_guide(c);
  if (!c.message.empty()) {
    heading("Last");
    line(kWhite, c.message);
  }
  const float foot = height - ImGui::GetTextLineHeightWithSpacing() - ImGui::GetStyle().WindowPadding.y;
  if (foot > ImGui::GetCursorPosY()) ImGui::SetCursorPosY(foot);
  line(kGrey, "F1 help    Esc menu");
  ImGui::End();
  ImGui::PopStyleVar();
}

void draw_help(float scale) {
  begin_middle("help", 760 * scale);
  line(kGreen, "Keys");
  if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
    const auto row = [](const char* keys, const char* action) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextColored(kAmber, "%s", keys);
      ImGui::TableNextColumn();
      line(action);
    };
    for (const devices::HelpLine& h : devices::help()) row(h.keys, h.action);
    row("F1 H", "this help on or off");
    row("F12", "save a picture of the window beside the recording");
    row("Esc", "menu: resume, restart, quit");
    ImGui::EndTable();
  }
  ImGui::End();
}

Choice draw_menu(const std::string& recording, float scale) {
  Choice choice = Choice::none;
  begin_middle("menu", 520 * scale);
  line(kGreen, "Paused");
  if (button("Resume (Esc)", scale)) choice = Choice::resume;
  if (button("Restart (R)", scale)) choice = Choice::restart;
  if (button("Quit (Q)", scale)) choice = Choice::quit;
  line(kGrey, "recording: " + recording);
  ImGui::End();
  return choice;
}

namespace {

void result_line(const Json& from, const char* key, const char* text, const char* format) {
  if (from.contains(key) && from[key].is_number())
    line(fmt::format("{}: {}", text, fmt::format(fmt::runtime(format), from[key].get<double>())));
}

}  // namespace

Choice draw_result(const Json& r, float scale) {
  Choice choice = Choice::none;
  begin_middle("result", 620 * scale);
  ImGui::SetWindowFontScale(1.4f);
  if (r.contains("failure"))
    line(kRed, "The simulation failed");
  else if (r["passed"].is_null())
    line(kWhite, "The end");
  else
    line(r["passed"].get<bool>() ? kGreen : kAmber, r["passed"].get<bool>() ? "Passed" : "Not passed");
  ImGui::SetWindowFontScale(1);
  if (r.contains("failure")) line(kRed, r["failure"].get<std::string>());
  if (r.contains("assessment")) {
    const Json& a = r["assessment"];
    result_line(a, "seconds", "time", "{:.0f} s");
    if (a.contains("score")) {
      result_line(a["score"], "total", "score", "{:.0f} of 100");
      result_line(a["score"], "quality", "quality", "{:.2f}");
      result_line(a["score"], "penalties", "penalties", "{:.0f}");
    }
    if (a.contains("errors"))
      for (const Json& e : a["errors"])
        line(kAmber,
             fmt::format("{:.0f} s  {}", e.value("at_s", e.value("at", 0.0)), e.value("meaning", std::string())));
  }
  for (const Json& tool : r["instruments"])
    line(kGrey,
         fmt::format("{}: {:.0f} mm", words(tool["name"].get<std::string>()), tool["path_length_mm"].get<double>()));
  if (r.contains("recording")) line(kGrey, "recording: " + r["recording"].get<std::string>());
  if (button("Again (R)", scale)) choice = Choice::restart;
  if (button("Quit (Q)", scale)) choice = Choice::quit;
  ImGui::End();
  return choice;
}

}  // namespace trocar::app
