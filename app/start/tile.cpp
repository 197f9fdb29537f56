#include "start/tile.hpp"

#include <algorithm>
#include <cmath>

#include "shell/ui.hpp"

namespace trocar::app {
namespace {

float tile_margin() { return 8 * ui::scale(); }
float picture_height(float width) { return std::round(0.5f * width); }
int lines_below(const TileLook& look) { return int(!look.detail.empty()) + int(!look.result.empty()); }

float title_height(const TileLook& look, float width) {
  return ImGui::CalcTextSize(look.title.c_str(), nullptr, false, width - 2 * tile_margin()).y;
}

/// The middle of the picture, as wide as the tile.
void draw_picture_of(const TileLook& look, ImVec2 low, ImVec2 high) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float share = look.aspect * (high.y - low.y) / (high.x - low.x);  // of the texture's height that is seen
  const float top = 0.5f * (1 - std::min(1.0f, share));
  draw.AddImageRounded(reinterpret_cast<ImTextureID>(std::uintptr_t(look.texture)), low, high, {0, top}, {1, 1 - top},
                       IM_COL32_WHITE, 4 * ui::scale(), ImDrawFlags_RoundCornersTop);
}

/// What an endoscope shows, in outline: two shafts in a circle.
void draw_placeholder(ImVec2 low, ImVec2 high) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 middle{0.5f * (low.x + high.x), 0.5f * (low.y + high.y)};
  const float radius = 0.4f * (high.y - low.y), thick = 0.05f * (high.y - low.y);
  const ImU32 faint = ImGui::GetColorU32({0.30f, 0.33f, 0.38f, 1});
  draw.AddRectFilled(low, high, ImGui::GetColorU32({0.11f, 0.12f, 0.14f, 1}), 4 * ui::scale(),
                     ImDrawFlags_RoundCornersTop);
  draw.AddCircle(middle, radius, faint, 48, 0.5f * thick);
  for (const float side : {-1.0f, 1.0f})
    draw.AddLine({middle.x + side * 0.7f * radius, middle.y + 0.7f * radius},
                 {middle.x + side * 0.15f * radius, middle.y}, faint, thick);
}

void draw_strip(const std::string& text, ImVec2 corner, const ImVec4& ground, bool from_below) {
  if (text.empty()) return;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const float pad = 5 * ui::scale();
  const ImVec2 low{corner.x, from_below ? corner.y - size.y - pad : corner.y};
  draw.AddRectFilled(low, {low.x + size.x + 2 * pad, low.y + size.y + pad}, ImGui::GetColorU32(ground),
                     3 * ui::scale());
  draw.AddText({low.x + pad, low.y + 0.5f * pad}, ImGui::GetColorU32(ui::kWhite), text.c_str());
}

void draw_words(const TileLook& look, ImVec2 at, float width) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float line = ImGui::GetTextLineHeight();
  draw.AddText(ImGui::GetFont(), ImGui::GetFontSize(), at, ImGui::GetColorU32(ui::kWhite), look.title.c_str(), nullptr,
               width);
  at.y += ImGui::CalcTextSize(look.title.c_str(), nullptr, false, width).y;
  if (!look.detail.empty()) {
    draw.AddText(at, ImGui::GetColorU32(ui::kGrey), ui::shortened(look.detail, width).c_str());
    at.y += line;
  }
  if (look.result.empty()) return;
  if (look.passed) {
    ui::draw_mark(ui::Mark::done, at, line);
    at.x += 1.3f * line, width -= 1.3f * line;
  }
  draw.AddText(at, ImGui::GetColorU32(look.passed ? ui::kBlue : ui::kGrey), ui::shortened(look.result, width).c_str());
}

}  // namespace

float tile_height(const TileLook& look, float width) {
  return picture_height(width) + title_height(look, width) + float(lines_below(look)) * ImGui::GetTextLineHeight() +
         1.5f * tile_margin();
}

bool draw_tile(const TileLook& look, ImVec2 size) {
  const ImVec2 low = ImGui::GetCursorScreenPos(), high{low.x + size.x, low.y + size.y};
  const bool chosen = ImGui::InvisibleButton(look.id.c_str(), size);
  ui::note_widget(look.id);
  if (!ImGui::IsItemVisible()) return chosen;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const bool hovered = ImGui::IsItemHovered();
  draw.AddRectFilled(low, high,
                     ImGui::GetColorU32(hovered ? ImVec4{0.26f, 0.29f, 0.34f, 1} : ImVec4{0.18f, 0.20f, 0.24f, 1}),
                     4 * ui::scale());
  const ImVec2 below{high.x, low.y + picture_height(size.x)};
  if (look.texture != 0)
    draw_picture_of(look, low, below);
  else
    draw_placeholder(low, below);
  const float gap = 4 * ui::scale();
  draw_strip(look.over, {low.x + gap, below.y - gap}, {0, 0, 0, 0.65f}, true);
  draw_strip(look.badge, {low.x + gap, low.y + gap}, {0.10f, 0.42f, 0.66f, 1}, false);
  draw_words(look, {low.x + tile_margin(), below.y + 0.5f * tile_margin()}, size.x - 2 * tile_margin());
  if (ImGui::IsItemFocused())
    draw.AddRect(low, high, ImGui::GetColorU32(ui::kOrange), 4 * ui::scale(), 0, 2.5f * ui::scale());
  return chosen;
}

}  // namespace trocar::app
