#include "guide/nearness_view.hpp"

#include <algorithm>
#include <cmath>

#include <trocar/core/text.hpp>

#include "shell/ui.hpp"

namespace trocar::app {
namespace {

using training::Nearness;

constexpr float kBar = 5, kGap = 5;  // [px at scale 1]

ImVec4 colour_of_row(const Nearness& row) { return row.fulfilled ? ui::kBlue : ui::kWhite; }

/// A filled circle with a tick, or a ring that fills.
void draw_ring(const Nearness& row, ImVec2 middle, float radius) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImU32 colour = ImGui::GetColorU32(colour_of_row(row)), faint = ImGui::GetColorU32({0.42f, 0.47f, 0.53f, 1});
  const float line = 2 * ui::scale();
  if (row.fulfilled) {
    draw.AddCircleFilled(middle, radius, colour);
    const ImU32 dark = ImGui::GetColorU32(ui::kDark);
    const ImVec2 low{middle.x - 0.1f * radius, middle.y + 0.45f * radius};
    draw.AddLine({middle.x - 0.5f * radius, middle.y}, low, dark, line);
    draw.AddLine(low, {middle.x + 0.55f * radius, middle.y - 0.45f * radius}, dark, line);
    return;
  }
  draw.AddCircle(middle, radius, faint, 0, line);
  if (row.share <= 0.01) return;
  constexpr float kTop = -1.5708f, kTurn = 6.2832f;
  draw.PathArcTo(middle, radius, kTop, kTop + kTurn * float(row.share), 24);
  draw.PathStroke(colour, 0, line);
}

void draw_nearness_bar(const Nearness& row, ImVec2 at, float width, float height) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const NearnessBar bar = bar_of(row);
  const auto x = [&](float share) { return at.x + width * share; };
  draw.AddRectFilled(at, {at.x + width, at.y + height}, ImGui::GetColorU32({0.16f, 0.19f, 0.23f, 1}), 2);
  if (bar.filled && bar.value > 0)
    draw.AddRectFilled(at, {x(bar.value), at.y + height}, ImGui::GetColorU32(colour_of_row(row)), 2);
  if (bar.filled) return;
  draw.AddRectFilled({x(bar.from), at.y}, {x(bar.to), at.y + height}, ImGui::GetColorU32({0.20f, 0.45f, 0.62f, 1}), 2);
  if (bar.value < 0) return;
  const float half = 2 * ui::scale();
  draw.AddRectFilled({x(bar.value) - half, at.y - half}, {x(bar.value) + half, at.y + height + half},
                     ImGui::GetColorU32(colour_of_row(row)));
}

std::string row_text(const Nearness& row) {
  if (!row.is_truth) return row.label;
  return row.wanted ? row.label : tr("not: {}", row.label);
}

constexpr float kBeside = 6;  // [px at scale 1] between texts of a row

std::string value_text(const Nearness& row) { return row.is_truth ? std::string() : row.shown_value(); }
std::string target_text(const Nearness& row) { return row.is_truth ? std::string() : "(" + row.target() + ")"; }
float figures_width(const Nearness& row) {
  return ImGui::CalcTextSize((value_text(row) + target_text(row)).c_str()).x +
         (row.is_truth ? 0 : kBeside * ui::scale());
}
float indent_of_rows() { return ImGui::GetTextLineHeight() + 4 * ui::scale(); }

/// Does a row's name need a line of its own?
bool takes_two_lines(const Nearness& row, float width) {
  const float name = ImGui::CalcTextSize(row_text(row).c_str()).x;
  return !row.is_truth && indent_of_rows() + name + kBeside * ui::scale() + figures_width(row) > width;
}

float row_height(const Nearness& row, float width) {
  const float lines = takes_two_lines(row, width) ? 2 : 1;
  return lines * ImGui::GetTextLineHeight() + (row.is_truth ? 0 : (kBar + kGap) * ui::scale());
}

void draw_nearness_row(const Nearness& row) {
  const float scale = ui::scale(), line = ImGui::GetTextLineHeight(), width = ImGui::GetContentRegionAvail().x;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float indent = indent_of_rows(), gap = kBeside * scale, right = figures_width(row);
  const bool two = takes_two_lines(row, width);
  draw_ring(row, {at.x + 0.45f * line, at.y + 0.5f * line}, 0.38f * line);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const std::string label = ui::shortened(row_text(row), width - indent - (two || row.is_truth ? 0 : right + gap));
  draw.AddText({at.x + indent, at.y}, ImGui::GetColorU32(row.fulfilled ? ui::kBlue : ui::kWhite), label.c_str());
  if (!row.is_truth) {
    const float x = at.x + width - right, y = at.y + (two ? line : 0);
    const std::string value = value_text(row);
    draw.AddText({x, y}, ImGui::GetColorU32(colour_of_row(row)), value.c_str());
    draw.AddText({x + ImGui::CalcTextSize(value.c_str()).x + gap, y}, ImGui::GetColorU32(ui::kGrey),
                 target_text(row).c_str());
    draw_nearness_bar(row, {at.x + indent, y + line + 2 * scale}, width - indent, kBar * scale);
  }
  ImGui::Dummy({width, row_height(row, width)});
}

}  // namespace

NearnessBar bar_of(const Nearness& row) {
  NearnessBar bar;
  const bool low = std::isfinite(row.low), high = std::isfinite(row.high);
  if (low && !high && row.low > 0) {  // something that is collected
    bar.filled = true;
    bar.value = row.known ? float(std::clamp(row.value / row.low, 0.0, 1.0)) : 0;
    return bar;
  }
  const double bound = low ? row.low : row.high;
  const double span = low && high ? std::max(row.high - row.low, 1e-9) : std::max(std::abs(bound), 1.0);
  double from = low ? row.low - span : std::min(0.0, row.high - span);
  const double to = high ? row.high + 2 * span : row.low + 2 * span;
  if (low && row.low >= 0) from = std::max(from, 0.0);
  const auto share = [&](double v) { return float(std::clamp((v - from) / (to - from), 0.0, 1.0)); };
  bar.value = row.known ? share(row.value) : -1;
  bar.from = low ? share(row.low) : 0;
  bar.to = high ? share(row.high) : 1;
  return bar;
}

float nearness_height(const std::vector<Nearness>& rows, float width) {
  float height = 0;
  for (const Nearness& row : rows) height += row_height(row, width) + ImGui::GetStyle().ItemSpacing.y;
  return height;
}

void draw_nearness(const std::vector<Nearness>& rows) {
  for (const Nearness& row : rows) draw_nearness_row(row);
}

}  // namespace trocar::app
