#include "guide/control_mark.hpp"

#include <algorithm>
#include <cmath>

#include <imgui.h>

#include <trocar/core/text.hpp>
#include <trocar/sim/stages/visibility.hpp>

#include "shell/ui.hpp"

namespace trocar::app {
namespace {

const ImVec4 kMark{0.42f, 0.75f, 0.95f, 0.9f};

void text_on_dark(ImDrawList& draw, ImVec2 at, const std::string& s) {
  const ImVec2 size = ImGui::CalcTextSize(s.c_str());
  const float pad = 3 * ui::scale();
  draw.AddRectFilled({at.x - pad, at.y - pad}, {at.x + size.x + pad, at.y + size.y + pad},
                     ImGui::GetColorU32({0, 0, 0, 0.55f}), 3);
  draw.AddText(at, ImGui::GetColorU32(kMark), s.c_str());
}

void draw_ring_at(ImDrawList& draw, ImVec2 at, const std::string& number) {
  const float radius = 9 * ui::scale(), line = 2 * ui::scale();
  draw.AddCircle(at, radius + 1, ImGui::GetColorU32({0, 0, 0, 0.6f}), 0, line + 2);
  draw.AddCircle(at, radius, ImGui::GetColorU32(kMark), 0, line);
  text_on_dark(draw, {at.x + radius + 5 * ui::scale(), at.y - 0.5f * ImGui::GetTextLineHeight()}, number);
}

void draw_edge_arrow(ImDrawList& draw, ImVec2 tip, ImVec2 towards, const std::string& text, const Area& area) {
  const float size = 16 * ui::scale();
  const ImVec2 back{tip.x - size * towards.x, tip.y - size * towards.y};
  const ImVec2 aside{-0.6f * size * towards.y, 0.6f * size * towards.x};
  draw.AddTriangleFilled(tip, {back.x + aside.x, back.y + aside.y}, {back.x - aside.x, back.y - aside.y},
                         ImGui::GetColorU32(kMark));
  const ImVec2 room = ImGui::CalcTextSize(text.c_str());
  ImVec2 at{back.x - (towards.x > 0 ? room.x + 0.6f * size : -0.6f * size), back.y - 0.5f * room.y};
  if (std::abs(towards.x) < 0.5f) at = {back.x - 0.5f * room.x, back.y + (towards.y > 0 ? -1.8f : 0.8f) * room.y};
  at.x = std::clamp(at.x, area.x + 4, std::max(area.x + 4, area.x + area.width - room.x - 4));
  at.y = std::clamp(at.y, area.y + 4, std::max(area.y + 4, area.y + area.height - room.y - 4));
  text_on_dark(draw, at, text);
}

}  // namespace

TipInPicture tip_in_circle(const sim::Model& model, const sim::State& state, int hand) {
  const kinematics::ScopeFrame scope = sim::scope_of(model, state);
  const Vec3d to = sim::tip_frame_of(model, state, size_t(hand)).tip - scope.eye;
  const double ahead = dot(to, scope.forward), half = std::tan(0.5 * model.scope.field_of_view);
  const double right = dot(to, scope.right), up = dot(to, scope.up);
  TipInPicture at;
  const double scale = ahead > 1e-4 ? 1 / (ahead * half) : 0;
  at.in_view = scale > 0 && scale * std::hypot(right, up) < 1;
  const double size = std::max(std::hypot(right, up), 1e-9);
  at.right = float(at.in_view ? scale * right : right / size);
  at.up = float(at.in_view ? scale * up : up / size);
  return at;
}

void draw_control_mark(const sim::Model& model, const sim::State& state, int hand, const Area& area, bool mirrored,
                       const std::string& key) {
  TipInPicture at = tip_in_circle(model, state, hand);
  if (mirrored) at.right = -at.right;
  const float radius = 0.5f * std::min(area.width, area.height);
  const ImVec2 middle{area.x + 0.5f * area.width, area.y + 0.5f * area.height};
  ImDrawList& draw = *ImGui::GetBackgroundDrawList();
  const std::string number = std::to_string(hand + 1);
  if (at.in_view) return draw_ring_at(draw, {middle.x + radius * at.right, middle.y - radius * at.up}, number);
  const float edge = 0.94f * radius;
  draw_edge_arrow(draw, {middle.x + edge * at.right, middle.y - edge * at.up}, {at.right, -at.up},
                  tr("{}: out of view. {} brings it into view", number, key), area);
}

}  // namespace trocar::app
