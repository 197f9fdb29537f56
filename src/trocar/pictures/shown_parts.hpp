// Which parts of a scene a picture shows, and how.
//
//   const ShownParts shown = parse_show("walls=hidden,uterus=wireframe");
//   options.styles = styles_of(shown, view.parts());
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <trocar/view/scene/scene_view.hpp>

namespace trocar::pictures {

/// Names of parts or groups, and how they are shown; later ones win.
using ShownParts = std::vector<std::pair<std::string, view::PartStyle>>;

inline constexpr const char* kShowHelp =
    "of pictures and film: PART=STYLE,... PART: a name in the scene, or organs | tubes | folds | vessels | walls | "
    "instruments | clips | fluids; STYLE: shaded | transparent | wireframe | hidden";

const char* name_of(view::PartStyle style);
const char* name_of(view::PartGroup group);
/// @throws core::BadInput naming what was expected
ShownParts parse_show(const std::string& text);
/// @throws core::BadInput naming the parts that there are, where one is not among them
std::vector<view::PartStyle> styles_of(const ShownParts& shown, const std::vector<view::ScenePart>& parts);

}  // namespace trocar::pictures
