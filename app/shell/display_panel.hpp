// How the parts of the scene are shown, as a menu: groups, and each of their parts.
#pragma once

#include <vector>

#include <trocar/view/scene/scene_view.hpp>

namespace trocar::app {

/// @param styles  in/out: of the parts; all shaded where it is empty  @return closed
bool draw_display(const std::vector<view::ScenePart>& parts, std::vector<view::PartStyle>& styles);

}  // namespace trocar::app
