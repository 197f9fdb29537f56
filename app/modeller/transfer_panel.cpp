#include "modeller/transfer_panel.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include <trocar/core/text.hpp>

#include "shell/ui.hpp"

namespace trocar::app {
namespace {

constexpr float kHeight = 96, kPointReach = 9;  // [px at scale 1]
constexpr std::size_t kMostPoints = 24;

struct Canvas {
  ImVec2 at, size;
  double low, high;

  ImVec2 spot(const volumes::TransferPoint& p) const {
    return {at.x + size.x * float((p.value - low) / (high - low)), at.y + size.y * float(1 - p.opacity)};
  }
  double value(float x) const { return low + (high - low) * std::clamp(double(x - at.x) / size.x, 0.0, 1.0); }
  double opacity(float y) const { return std::clamp(1 - double(y - at.y) / size.y, 0.0, 1.0); }
};

ImU32 colour_of_point(const volumes::TransferPoint& p, int alpha) {
  const auto byte = [](double v) { return int(255 * std::clamp(v, 0.0, 1.0)); };
  return IM_COL32(byte(p.colour[0]), byte(p.colour[1]), byte(p.colour[2]), alpha);
}

void paint_function(const volumes::TransferFunction& t, const Canvas& c, int chosen) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(c.at, {c.at.x + c.size.x, c.at.y + c.size.y}, IM_COL32(30, 33, 38, 255));
  constexpr int kColumns = 64;
  for (int i = 0; i < kColumns; ++i) {
    const float x = c.at.x + c.size.x * float(i) / kColumns, next = c.at.x + c.size.x * float(i + 1) / kColumns;
    const volumes::TransferPoint p = t.at(c.value((x + next) / 2));
    list.AddRectFilled({x, c.spot(p).y}, {next, c.at.y + c.size.y}, colour_of_point(p, 150));
  }
  for (std::size_t i = 0; i + 1 < t.points.size(); ++i)
    list.AddLine(c.spot(t.points[i]), c.spot(t.points[i + 1]), IM_COL32(230, 232, 235, 255), 1.4f);
  for (std::size_t i = 0; i < t.points.size(); ++i) {
    list.AddCircleFilled(c.spot(t.points[i]), 5, colour_of_point(t.points[i], 255));
    list.AddCircle(c.spot(t.points[i]), 5.5f,
                   int(i) == chosen ? IM_COL32(255, 255, 255, 255) : IM_COL32(20, 22, 26, 255), 0, 1.5f);
  }
}

int point_under(const volumes::TransferFunction& t, const Canvas& c, ImVec2 mouse) {
  int best = -1;
  float nearest = kPointReach * ui::scale();
  for (std::size_t i = 0; i < t.points.size(); ++i) {
    const ImVec2 s = c.spot(t.points[i]);
    const float off = std::hypot(s.x - mouse.x, s.y - mouse.y);
    if (off < nearest) nearest = off, best = int(i);
  }
  return best;
}

}  // namespace

bool draw_transfer(volumes::TransferFunction& t, double low, double high, int& chosen) {
  const ImGuiIO& io = ImGui::GetIO();
  const Canvas c{ImGui::GetCursorScreenPos(), {ImGui::GetContentRegionAvail().x, kHeight * ui::scale()}, low, high};
  ImGui::InvisibleButton("transfer", c.size, ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
  ui::note_widget("transfer");
  bool changed = false;
  if (ImGui::IsItemHovered()) {
    const int under = point_under(t, c, io.MousePos);
    if (io.MouseClicked[0]) chosen = under;
    if (io.MouseDoubleClicked[0] && under < 0 && t.points.size() < kMostPoints) {
      volumes::TransferPoint p = t.at(c.value(io.MousePos.x));
      p.value = c.value(io.MousePos.x);
      p.opacity = c.opacity(io.MousePos.y);
      const auto behind = std::upper_bound(t.points.begin(), t.points.end(), p.value,
                                           [](double v, const volumes::TransferPoint& q) { return v < q.value; });
      chosen = int(t.points.insert(behind, p) - t.points.begin());
      changed = true;
    }
    if (io.MouseClicked[1] && under >= 0 && t.points.size() > 2) {
      t.points.erase(t.points.begin() + under);
      chosen = -1;
      changed = true;
    }
    const std::string tip = tr("{:.0f}: opacity {:.2f}\nDouble click: add a point. Right click: remove it.",
                               c.value(io.MousePos.x), c.opacity(io.MousePos.y));
    ImGui::SetTooltip("%s", tip.c_str());
  }
  chosen = std::min(chosen, int(t.points.size()) - 1);
  if (ImGui::IsItemActive() && io.MouseDown[0] && chosen >= 0 && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) {
    const auto at = t.points.begin() + chosen;  // between its neighbours
    const double least = chosen > 0 ? (at - 1)->value + 1e-6 : low;
    const double most = at + 1 != t.points.end() ? (at + 1)->value - 1e-6 : high;
    at->value = std::clamp(c.value(io.MousePos.x), std::min(least, most), most);
    at->opacity = c.opacity(io.MousePos.y);
    changed = true;
  }
  paint_function(t, c, chosen);
  if (chosen >= 0) {
    auto& colour = t.points[std::size_t(chosen)].colour;
    float edited[3] = {float(colour[0]), float(colour[1]), float(colour[2])};
    if (ImGui::ColorEdit3(tr("colour of the point"), edited, ImGuiColorEditFlags_NoInputs)) {
      colour = {edited[0], edited[1], edited[2]};
      changed = true;
    }
  }
  return changed;
}

}  // namespace trocar::app
