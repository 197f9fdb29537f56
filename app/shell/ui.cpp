#include "shell/ui.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <imgui_internal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <trocar/core/font_file.hpp>
#include <trocar/core/text.hpp>

extern char** environ;

namespace trocar::app::ui {
namespace {

constexpr float kTextHeight = 16, kTitleHeight = 25;

float g_scale = 1, g_middle = 0;
ImFont* g_title = nullptr;
std::vector<Widget> g_widgets;

/// Latin, Greek, Cyrillic, punctuation, arrows: names of people.
const ImWchar kGlyphs[] = {0x20, 0x24F, 0x370, 0x52F, 0x1E00, 0x1EFF, 0x2010, 0x2044, 0x2190, 0x2195, 0};

ImFont* load_font(const char* file, float height) {
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  std::error_code error;
  if (std::filesystem::exists(file, error))
    if (ImFont* font = fonts.AddFontFromFileTTF(file, height, nullptr, kGlyphs)) return font;
  ImFontConfig config;
  config.SizePixels = height;
  return fonts.AddFontDefault(&config);  // ImGui's own, a 13 px bitmap
}

void colour_buttons(const ButtonLook& look) {
  const ImVec4 usual = look.primary ? ImVec4{0.10f, 0.42f, 0.66f, 1} : ImVec4{0.22f, 0.25f, 0.29f, 1};
  const auto lighter = [&](float by) { return ImVec4{usual.x + by, usual.y + by, usual.z + by, 1}; };
  ImGui::PushStyleColor(ImGuiCol_Button, usual);
  ImGui::PushStyleColor(ImGuiCol_ButtonHovered, lighter(0.10f));
  ImGui::PushStyleColor(ImGuiCol_ButtonActive, lighter(0.18f));
}

/// By how much a label must shrink to fit into `width` [px]; what follows "##" is not shown.
float fitting(const std::string& label, float width) {
  constexpr float kSmallest = 0.55f;
  const float wide = ImGui::CalcTextSize(label.c_str(), nullptr, true).x;
  return wide <= width ? 1 : std::max(kSmallest, width / wide);
}

}  // namespace

void load_fonts(float scale) {
  g_scale = scale;
  ImGuiStyle& style = ImGui::GetStyle() = ImGuiStyle();
  ImGui::StyleColorsDark();
  style.WindowRounding = style.FrameRounding = style.ChildRounding = style.GrabRounding = 4;
  style.WindowBorderSize = 0;
  style.FramePadding = {8, 5};
  style.ItemSpacing = {8, 6};
  style.WindowPadding = {12, 10};
  style.Colors[ImGuiCol_WindowBg] = kDark;
  style.Colors[ImGuiCol_Text] = kWhite;
  style.Colors[ImGuiCol_ChildBg] = {0.13f, 0.14f, 0.17f, 1};
  style.Colors[ImGuiCol_FrameBg] = {0.20f, 0.22f, 0.26f, 1};
  style.Colors[ImGuiCol_NavHighlight] = kOrange;
  style.ScaleAllSizes(scale);
  ImGui::GetIO().Fonts->Clear();
  load_font(core::font_file("DejaVuSans.ttf").c_str(), std::round(kTextHeight * scale));
  g_title = load_font(core::font_file("DejaVuSans-Bold.ttf").c_str(), std::round(kTitleHeight * scale));
  ImGui::GetIO().Fonts->Build();
}

float scale() { return g_scale; }
ImFont* title_font() { return g_title; }

std::string wrapped(const std::string& s, float width) {
  std::string out;
  std::size_t line = 0;  // where the last line of `out` begins
  for (std::size_t at = 0; at < s.size();) {
    const std::size_t end = std::min(s.find_first_of(" \n", at), s.size());
    const std::string tried = out.substr(line) + s.substr(at, end - at);
    if (out.size() > line && ImGui::CalcTextSize(tried.c_str()).x > width) {
      out.back() = '\n';  // the space before this word
      line = out.size();
    }
    out += s.substr(at, end + 1 - at);
    if (end < s.size() && s[end] == '\n') line = out.size();
    at = end + 1;
  }
  return out;
}

void text(const std::string& s, const ImVec4& colour) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::PushTextWrapPos(0);  // for a word that is wider than everything
  const std::string lines = wrapped(tr(s.c_str()), ImGui::GetContentRegionAvail().x);
  ImGui::TextUnformatted(lines.c_str(), lines.c_str() + lines.size());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

void title(const std::string& s, const ImVec4& colour) {
  ImGui::PushFont(g_title);
  text(s, colour);
  ImGui::PopFont();
}

void heading(const std::string& s) {
  ImGui::Dummy({0, 2 * g_scale});
  ImGui::Separator();
  text(s, kGrey);
}

std::string shortened(const std::string& s, float width) {
  if (ImGui::CalcTextSize(s.c_str()).x <= width) return s;
  std::string out = s;
  while (!out.empty()) {
    do out.pop_back();
    while (!out.empty() && (static_cast<unsigned char>(out.back()) & 0xC0) == 0x80);
    if (!out.empty() && (static_cast<unsigned char>(out.back()) & 0x80)) out.pop_back();  // a character's first byte
    if (ImGui::CalcTextSize((out + "...").c_str()).x <= width) break;
  }
  return out + "...";
}

ImVec4 colour_of(Mark m) {
  switch (m) {
    case Mark::done:
      return kBlue;
    case Mark::now:
      return kWhite;
    case Mark::error:
      return kRed;
    case Mark::warning:
      return kOrange;
    case Mark::open:
    case Mark::note:
      return kGrey;
  }
  return kWhite;
}

void mark(Mark m) {
  const float size = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::Dummy({size, size});
  ImGui::SameLine(0, 5 * g_scale);
  draw_mark(m, at, size);
}

void draw_mark(Mark m, ImVec2 at, float size) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImU32 colour = ImGui::GetColorU32(colour_of(m));
  const auto p = [&](float x, float y) { return ImVec2{at.x + x * size, at.y + y * size}; };
  const float thick = std::max(1.5f, 0.12f * size);
  switch (m) {
    case Mark::done: {
      const ImVec2 tick[] = {p(0.15f, 0.55f), p(0.4f, 0.8f), p(0.9f, 0.2f)};
      draw.AddPolyline(tick, 3, colour, 0, 1.4f * thick);
      break;
    }
    case Mark::now:
      draw.AddTriangleFilled(p(0.2f, 0.15f), p(0.2f, 0.9f), p(0.85f, 0.52f), colour);
      break;
    case Mark::open:
      draw.AddRect(p(0.22f, 0.27f), p(0.78f, 0.83f), colour, 0, 0, 0.7f * thick);
      break;
    case Mark::error:
    case Mark::warning: {
      draw.AddTriangleFilled(p(0.5f, 0.05f), p(0.0f, 0.95f), p(1.0f, 0.95f), colour);
      const ImU32 black = ImGui::GetColorU32({0, 0, 0, 1});
      draw.AddLine(p(0.5f, 0.35f), p(0.5f, 0.68f), black, thick);
      draw.AddLine(p(0.5f, 0.76f), p(0.5f, 0.86f), black, thick);
      break;
    }
    case Mark::note:
      draw.AddCircleFilled(p(0.5f, 0.55f), 0.16f * size, colour);
      break;
  }
}

bool button(const std::string& label, const ButtonLook& look) {
  colour_buttons(look);
  ImGui::BeginDisabled(!look.enabled);
  const float height = look.height > 0 ? look.height * g_scale : 0;
  const char* shown = tr(label.c_str());
  const float shrunk = look.width > 0 ? fitting(shown, look.width * g_scale - 2 * ImGui::GetStyle().FramePadding.x) : 1;
  if (shrunk < 1) ImGui::SetWindowFontScale(shrunk);
  const bool pressed = ImGui::Button(shown, {look.width * g_scale, height});
  if (shrunk < 1) ImGui::SetWindowFontScale(1);
  ImGui::EndDisabled();
  ImGui::PopStyleColor(3);
  if (look.enabled) note_widget(label);
  if (look.tip && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tr(look.tip));
  return pressed;
}

bool checkbox(const std::string& label, bool& value) {
  const float box = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x;
  ImGui::PushID(label.c_str());
  const bool changed =
      ImGui::Checkbox((wrapped(tr(label.c_str()), ImGui::GetContentRegionAvail().x - box) + "###box").c_str(), &value);
  ImGui::PopID();
  note_widget(label);
  return changed;
}

bool slider(const std::string& label, double& value, double low, double high, const char* format, bool logarithmic) {
  ImGui::SetNextItemWidth(170 * g_scale);
  const int flags = ImGuiSliderFlags_AlwaysClamp | (logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
  const bool changed = ImGui::SliderScalar(tr(label.c_str()), ImGuiDataType_Double, &value, &low, &high, format, flags);
  note_widget(label);
  return changed;
}

void beside(float width) {
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  if (ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + width * g_scale <= right) ImGui::SameLine();
}

void take_focus() { ImGui::SetFocusID(ImGui::GetItemID(), ImGui::GetCurrentWindow()); }

void begin_screen(const char* name) {
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize(ImGui::GetIO().DisplaySize);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::PopStyleVar();
}

void set_middle(float width) { g_middle = width; }

void begin_middle(const char* name, float width) {
  ImVec2 size = ImGui::GetIO().DisplaySize;
  constexpr float kWide = 700;  // wider ones need the whole window
  if (g_middle > 0 && width <= kWide) size.x = g_middle;
  const float most = std::min(width * g_scale, 0.97f * size.x);
  ImGui::SetNextWindowPos({0.5f * size.x, 0.5f * size.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({most, 0}, {most, 0.97f * size.y});
  ImGui::SetNextWindowBgAlpha(0.96f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {18 * g_scale, 14 * g_scale});
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
  ImGui::PopStyleVar(2);
}

namespace {
ImVec2 upper_corner(ImVec2 a, ImVec2 b) { return {std::max(a.x, b.x), std::max(a.y, b.y)}; }
ImVec2 lower_corner(ImVec2 a, ImVec2 b) { return {std::min(a.x, b.x), std::min(a.y, b.y)}; }
}  // namespace

void note_widget(const std::string& id) {
  if (!ImGui::IsItemVisible()) return;
  const ImDrawList& list = *ImGui::GetWindowDrawList();  // of a button half scrolled away, the half that can be pressed
  const ImVec2 low = upper_corner(ImGui::GetItemRectMin(), list.GetClipRectMin());
  const ImVec2 high = lower_corner(ImGui::GetItemRectMax(), list.GetClipRectMax());
  constexpr float kPressable = 4;  // [px]
  if (high.x - low.x < kPressable || high.y - low.y < kPressable) return;
  g_widgets.push_back({id, int(0.5f * (low.x + high.x)), int(0.5f * (low.y + high.y)), ImGui::IsItemFocused()});
}

std::vector<Widget> take_widgets() { return std::exchange(g_widgets, {}); }

bool open_in_browser(const std::string& path) {
  std::string program = "xdg-open", file = path;
  char* words[] = {program.data(), file.data(), nullptr};
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  for (const int stream : {0, 1, 2})
    posix_spawn_file_actions_addopen(&quiet, stream, "/dev/null", stream == 0 ? O_RDONLY : O_WRONLY, 0);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, program.c_str(), &quiet, nullptr, words, environ);
  posix_spawn_file_actions_destroy(&quiet);
  if (failed) return false;
  std::thread([child] {  // it may live long; nobody waits for it but this
    int status = 0;
    waitpid(child, &status, 0);
  })
      .detach();
  return true;
}

}  // namespace trocar::app::ui
