// A file may be like another one of its kind: under `like` it names that file, whose keys stand for those that are not
// here, all but a few that every file says itself.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include <trocar/scene/json/shape.hpp>

namespace trocar::scene {

inline constexpr const char* kLike = "like";

/// Never comes from the file that this one is like.
inline bool is_own(std::string_view key) {
  constexpr std::array<std::string_view, 4> kOwn{"$schema", "format", "name", kLike};
  return std::find(kOwn.begin(), kOwn.end(), key) != kOwn.end();
}

/// Of a file that is like another one: only what it says itself is needed.
inline Shape like_another(Shape whole) {
  for (Key& key : whole.keys) key.required = key.required && is_own(key.name);
  return whole;
}

}  // namespace trocar::scene
