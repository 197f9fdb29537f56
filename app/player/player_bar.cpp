#include "player/player_bar.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include <trocar/core/text.hpp>
#include <trocar/core/tick.hpp>
#include <trocar/pictures/camera_choice.hpp>

#include "shell/ui.hpp"

namespace trocar::app {
namespace {

constexpr float kCatch = 7;         // [px at scale 1] a mark is met this far from it
constexpr double kWheelZoom = 0.8;  // a notch

ImU32 colour_of(attempt::TimelineMark::Kind kind) {
  switch (kind) {
    case attempt::TimelineMark::Kind::step:
      return ImGui::GetColorU32(ui::kBlue);
    case attempt::TimelineMark::Kind::error:
      return ImGui::GetColorU32(ui::kOrange);
    case attempt::TimelineMark::Kind::damage:
      return ImGui::GetColorU32(ui::kRed);
    case attempt::TimelineMark::Kind::event:
      break;
  }
  return ImGui::GetColorU32(ui::kGrey);
}

/// Each kind has a shape of its own: a dot what happened, a square a step done, a triangle an error, a cross damage.
void draw_mark(ImDrawList& to, attempt::TimelineMark::Kind kind, ImVec2 at, float size, float low) {
  const ImU32 colour = colour_of(kind);
  to.AddLine({at.x, at.y}, {at.x, low}, (colour & 0x00ffffffu) | 0x70000000u);
  switch (kind) {
    case attempt::TimelineMark::Kind::event:
      to.AddCircleFilled(at, 0.7f * size, colour);
      break;
    case attempt::TimelineMark::Kind::step:
      to.AddRectFilled({at.x - size, at.y - size}, {at.x + size, at.y + size}, colour);
      break;
    case attempt::TimelineMark::Kind::error:
      to.AddTriangleFilled({at.x, at.y - 1.3f * size}, {at.x - 1.2f * size, at.y + size},
                           {at.x + 1.2f * size, at.y + size}, colour);
      break;
    case attempt::TimelineMark::Kind::damage:
      to.AddLine({at.x - size, at.y - size}, {at.x + size, at.y + size}, colour, 2);
      to.AddLine({at.x - size, at.y + size}, {at.x + size, at.y - size}, colour, 2);
      break;
  }
}

/// Marks of a kind lie in a row of their own, so that an error is not hidden by what happened with it.
float row_of(attempt::TimelineMark::Kind kind) {
  return kind == attempt::TimelineMark::Kind::event ? 0.75f : kind == attempt::TimelineMark::Kind::step ? 0.5f : 0.25f;
}

struct Field {
  ImVec2 low, high;
  float x(const attempt::Timeline& line, double tick) const {
    return low.x + float(line.place(tick)) * (high.x - low.x);
  }
  bool holds(float px) const { return px >= low.x - 0.5f && px <= high.x + 0.5f; }
  double place(float px) const { return double((px - low.x) / std::max(1.0f, high.x - low.x)); }
};

std::string grid_text(double seconds, double step) {
  const int minutes = int(seconds / 60 + 1e-9);
  const double rest = std::max(0.0, seconds - 60 * minutes);
  return step >= 1 ? fmt::format("{}:{:02.0f}", minutes, rest) : fmt::format("{}:{:05.2f}", minutes, rest);
}

void draw_grid(ImDrawList& to, const attempt::Timeline& line, const Field& field, float scale) {
  const double step = line.grid(int((field.high.x - field.low.x) / (80 * scale)));
  for (double s = std::ceil(line.from() * core::kTick / step) * step; s * double(core::kTicksPerSecond) <= line.to();
       s += step) {
    const float x = field.x(line, s * double(core::kTicksPerSecond));
    to.AddLine({x, field.low.y}, {x, field.high.y}, IM_COL32(255, 255, 255, 26));
    to.AddText({x + 3 * scale, field.high.y + 2 * scale}, IM_COL32(170, 175, 182, 255), grid_text(s, step).c_str());
  }
}

void draw_field(const BarContent& c, const attempt::Timeline& line, const Field& field, float scale) {
  ImDrawList& to = *ImGui::GetWindowDrawList();
  to.AddRectFilled(field.low, field.high, IM_COL32(30, 33, 38, 255), 3 * scale);
  const auto stretch = [&](double from, double until, ImU32 colour) {
    const float a = std::max(field.low.x, field.x(line, from)), b = std::min(field.high.x, field.x(line, until));
    if (b > a) to.AddRectFilled({a, field.low.y}, {b, field.high.y}, colour);
  };
  stretch(0, double(c.known_until), IM_COL32(48, 56, 66, 255));
  if (c.differs_from < line.last()) stretch(double(c.differs_from), double(line.last()), IM_COL32(74, 40, 34, 255));
  draw_grid(to, line, field, scale);
  for (const attempt::TimelineMark& m : c.found.marks) {
    const float x = field.x(line, double(m.tick));
    if (!field.holds(x)) continue;
    draw_mark(to, m.kind, {x, field.low.y + row_of(m.kind) * (field.high.y - field.low.y)}, 4.5f * scale, field.high.y);
  }
  const float x = field.x(line, double(c.now));
  if (!field.holds(x)) return;
  to.AddLine({x, field.low.y - 4 * scale}, {x, field.high.y + 2 * scale}, IM_COL32(255, 255, 255, 255), 2 * scale);
  to.AddTriangleFilled({x - 5 * scale, field.low.y - 6 * scale}, {x + 5 * scale, field.low.y - 6 * scale},
                       {x, field.low.y + 2 * scale}, IM_COL32(255, 255, 255, 255));
}

std::vector<const attempt::TimelineMark*> marks_at(const BarContent& c, const attempt::Timeline& line,
                                                   const Field& field, float x, float scale) {
  std::vector<const attempt::TimelineMark*> near;
  for (const attempt::TimelineMark& m : c.found.marks)
    if (std::fabs(field.x(line, double(m.tick)) - x) <= kCatch * scale) near.push_back(&m);
  return near;
}

void tell_marks(const std::vector<const attempt::TimelineMark*>& marks, std::uint64_t under) {
  constexpr std::size_t kMost = 8;
  ImGui::BeginTooltip();
  if (marks.empty()) ImGui::TextUnformatted(attempt::clock_text(under).c_str());
  for (std::size_t i = 0; i < marks.size() && i < kMost; ++i) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour_of(marks[i]->kind));
    ImGui::TextUnformatted(fmt::format("{}  {}", attempt::clock_text(marks[i]->tick), marks[i]->text).c_str());
    ImGui::PopStyleColor();
  }
  if (marks.size() > kMost) ImGui::TextUnformatted(tr("and {} more", marks.size() - kMost).c_str());
  ImGui::EndTooltip();
}

void draw_timeline(const BarContent& c, attempt::Timeline& line, float scale, PlayerCommands& commands,
                   std::uint64_t& seek) {
  const ImVec2 at = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
  const float labels = ImGui::GetTextLineHeight() + 4 * scale, above = 6 * scale;
  const Field field{{at.x, at.y + above},
                    {at.x + std::max(20.0f, room.x), at.y + above + std::max(20.0f, room.y - labels - above)}};
  draw_field(c, line, field, scale);
  ImGui::SetCursorScreenPos(at);
  ImGui::InvisibleButton("timeline", {field.high.x - field.low.x, field.high.y - at.y + labels},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
  ui::note_widget("timeline");
  const ImGuiIO& io = ImGui::GetIO();
  const double place = field.place(io.MousePos.x);
  const auto near = marks_at(c, line, field, io.MousePos.x, scale);
  if (ImGui::IsItemActive() && io.MouseDown[0]) {
    // A click on a mark goes there exactly; dragging goes where the pointer is.
    seek = near.empty() || ImGui::IsMouseDragging(0) ? line.tick_at(place) : near.front()->tick;
  }
  if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) commands.show_all = true;
  if (!ImGui::IsItemHovered()) return;
  if (io.MouseWheel != 0) {
    const double around = line.from() + place * (line.to() - line.from());
    line.zoom(std::pow(kWheelZoom, double(io.MouseWheel)), around);
  }
  tell_marks(near, line.tick_at(place));
}

/// A small button; those who look for it find it by its tip.
bool small_button(const char* label, const char* tip, bool lit = false) {
  if (lit) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyle().Colors[ImGuiCol_ButtonActive]);
  const float wide = ImGui::CalcTextSize(label, nullptr, true).x + 2 * ImGui::GetStyle().FramePadding.x;
  if (wide > ImGui::GetContentRegionAvail().x) ImGui::NewLine();
  const bool pressed = ImGui::Button(label);
  if (lit) ImGui::PopStyleColor();
  ui::note_widget(tip);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tip);
  ImGui::SameLine();
  return pressed;
}

void space(float width) {
  ImGui::Dummy({width, 0});
  ImGui::SameLine();
}

void draw_time_buttons(const BarContent& c, PlayerCommands& commands) {
  commands.to_start |= small_button("|<", tr("Start (Home)"));
  commands.previous_step |= small_button(tr("< step"), tr("Previous step (Shift Page Up)"));
  commands.previous_mark |= small_button(tr("< mark"), tr("Previous mark (Page Up)"));
  if (small_button("<", tr("One picture back (Left)"))) commands.ticks -= int(attempt::kFrameTicks);
  const std::string play = fmt::format("{}###play", c.playing ? tr("Pause") : tr(" Play "));
  commands.toggle_play |= small_button(play.c_str(), tr("Play, pause (Space)"), c.playing);
  if (small_button(">", tr("One picture forward (Right)"))) commands.ticks += int(attempt::kFrameTicks);
  commands.next_mark |= small_button(tr("mark >"), tr("Next mark (Page Down)"));
  commands.next_step |= small_button(tr("step >"), tr("Next step (Shift Page Down)"));
  commands.to_end |= small_button(">|", tr("End (End)"));
}

void draw_speed_buttons(const BarContent& c, PlayerCommands& commands) {
  constexpr double kOffered[] = {0.5, 1, 2, 4};
  commands.slower |= small_button("-", tr("Slower (Down)"));
  bool offered = false;
  for (const double speed : kOffered) {
    const std::string label = fmt::format("{:g}x", speed);
    if (small_button(label.c_str(), tr("Speed {}", label).c_str(), c.speed == speed)) commands.speed = speed;
    offered |= c.speed == speed;
  }
  if (!offered) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(fmt::format("({:g}x)", c.speed).c_str());
    ImGui::SameLine();
  }
  commands.faster |= small_button("+", tr("Faster (Up)"));
}

void draw_buttons(const BarContent& c, float scale, PlayerCommands& commands) {
  draw_time_buttons(c, commands);
  space(8 * scale);
  draw_speed_buttons(c, commands);
  ImGui::NewLine();
  if (small_button(tr("Endoscope"), tr("Endoscope view (1)"), c.endoscope)) commands.preset = 0;
  int number = 1;
  for (const pictures::CameraPreset& preset : pictures::kCameraPresets) {
    if (small_button(preset.name, preset.meaning)) commands.preset = number;
    ++number;
  }
  commands.inset |= small_button(tr("Both"), tr("Small picture on, off (V)"), c.inset);
  space(8 * scale);
  commands.captions |= small_button(tr("Captions"), tr("Captions on, off (T)"), c.captions);
  commands.film |= small_button(tr("Export"), tr("Export this section as video (X)"));
  space(8 * scale);
  if (c.now_you)
    commands.now_you |= small_button(tr("Now you"), tr("Do the same exercise with the same patient"), true);
  if (c.inside) commands.leave |= small_button(tr("Back"), tr("Back to Trocar"));
  ImGui::NewLine();
}

}  // namespace

float bar_height(float width, float scale) {
  constexpr float kUsual = 164, kButtons = 590, kTwoMoreRows = 68;  // [px at scale 1]
  return scale * (width < kButtons * scale ? kUsual + kTwoMoreRows : kUsual);
}

void draw_bar(const BarContent& content, attempt::Timeline& line, float width, float top, float height,
              PlayerCommands& commands, std::uint64_t& seek) {
  const float scale = ui::scale();
  ImGui::SetNextWindowPos({0, top});
  ImGui::SetNextWindowSize({width, height});
  ImGui::SetNextWindowBgAlpha(1);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
  ImGui::Begin("bar", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                   ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoBringToFrontOnFocus);
  draw_buttons(content, scale, commands);
  draw_timeline(content, line, scale, commands, seek);
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace trocar::app
