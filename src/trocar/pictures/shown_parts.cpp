#include <algorithm>
#include <iterator>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/pictures/shown_parts.hpp>

namespace trocar::pictures {

using view::PartGroup;
using view::PartStyle;

namespace {

constexpr const char* kStyles[] = {"shaded", "transparent", "wireframe", "hidden"};
constexpr const char* kGroups[] = {"organs",      "tubes", "folds", "vessels", "walls",
                                   "instruments", "clips", "marks", "fluids",  "objects"};

[[noreturn]] void refuse_parts(const std::string& what) { throw core::BadInput({{{"--show", 0, 0}, what}}); }

}  // namespace

const char* name_of(PartStyle style) { return kStyles[std::size_t(style)]; }
const char* name_of(PartGroup group) { return kGroups[std::size_t(group)]; }

ShownParts parse_show(const std::string& text) {
  ShownParts shown;
  std::istringstream items(text);
  for (std::string item; std::getline(items, item, ',');) {
    const std::size_t equal = item.rfind('=');
    const std::string style = equal == std::string::npos ? "" : item.substr(equal + 1);
    const auto known = std::find(std::begin(kStyles), std::end(kStyles), style);
    if (known == std::end(kStyles) || equal == 0)
      refuse_parts(tr("expected PART=STYLE with STYLE one of {}, got '{}'", fmt::join(kStyles, ", "), item));
    shown.push_back({item.substr(0, equal), PartStyle(known - std::begin(kStyles))});
  }
  return shown;
}

std::vector<PartStyle> styles_of(const ShownParts& shown, const std::vector<view::ScenePart>& parts) {
  if (shown.empty()) return {};
  std::vector<PartStyle> styles(parts.size(), PartStyle::shaded);
  for (const auto& [name, style] : shown) {
    bool found = std::find(std::begin(kGroups), std::end(kGroups), name) != std::end(kGroups);
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (name == parts[i].name || name == name_of(parts[i].group)) styles[i] = style, found = true;
    if (found) continue;
    std::vector<std::string> names(std::begin(kGroups), std::end(kGroups));
    for (const view::ScenePart& p : parts) names.push_back(p.name);
    refuse_parts(tr("expected a part of the scene ({}), got '{}'", fmt::join(names, ", "), name));
  }
  return styles;
}

}  // namespace trocar::pictures
