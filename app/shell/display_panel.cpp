#include "shell/display_panel.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>

#include <trocar/pictures/shown_parts.hpp>

#include "shell/ui.hpp"

namespace trocar::app {

using view::PartGroup;
using view::PartStyle;

namespace {

constexpr PartStyle kAllStyles[] = {PartStyle::shaded, PartStyle::transparent, PartStyle::wireframe, PartStyle::hidden};

/// A row of styles for the parts that `is_of` takes; what is chosen is set in all of them. @param solid  has edges
template <class IsOf>
void draw_row(const std::string& name, bool solid, std::vector<PartStyle>& styles, IsOf&& is_of) {
  ImGui::PushID(name.c_str());
  for (const PartStyle style : kAllStyles) {
    bool all = true;
    for (std::size_t i = 0; i < styles.size(); ++i) all = all && (!is_of(i) || styles[i] == style);
    if (style != PartStyle::shaded) ImGui::SameLine(0, 3 * ui::scale());
    const std::string label = fmt::format("{}##{}", pictures::name_of(style), name);
    const bool can = solid || style == PartStyle::shaded || style == PartStyle::hidden;
    if (!ui::button(label, {.width = 104, .height = 26, .primary = all, .enabled = can})) continue;
    for (std::size_t i = 0; i < styles.size(); ++i)
      if (is_of(i)) styles[i] = style;
  }
  ImGui::SameLine();
  ui::text(name);
  ImGui::PopID();
}

}  // namespace

bool draw_display(const std::vector<view::ScenePart>& parts, std::vector<PartStyle>& styles) {
  styles.resize(parts.size(), PartStyle::shaded);
  ui::begin_middle("display", 690);
  ui::title("Display");
  const float room = 0.97f * ImGui::GetIO().DisplaySize.y - 120 * ui::scale();
  ImGui::BeginChild("parts", {0, std::min(room, 540 * ui::scale())}, false, ImGuiWindowFlags_NavFlattened);
  for (int g = 0; g <= int(PartGroup::objects); ++g) {
    const auto of_group = [&](std::size_t i) { return parts[i].group == PartGroup(g); };
    std::size_t count = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) count += of_group(i);
    if (count == 0) continue;
    const std::string name = pictures::name_of(PartGroup(g));
    const bool solid = PartGroup(g) != PartGroup::fluids;
    draw_row("all " + name, solid, styles, of_group);
    if (count == 1 || !ImGui::TreeNode(name.c_str(), "each of the %d", int(count))) continue;
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (of_group(i)) draw_row(parts[i].name, solid, styles, [i](std::size_t k) { return k == i; });
    ImGui::TreePop();
  }
  ImGui::EndChild();
  const bool closed = ui::button("Close", {.width = 130, .primary = true});
  ImGui::SetItemDefaultFocus();
  ImGui::SameLine();
  const bool plain = std::all_of(styles.begin(), styles.end(), [](PartStyle s) { return s == PartStyle::shaded; });
  if (ui::button("All as usual", {.width = 150, .enabled = !plain})) styles.assign(parts.size(), PartStyle::shaded);
  ImGui::End();
  return closed;
}

}  // namespace trocar::app
