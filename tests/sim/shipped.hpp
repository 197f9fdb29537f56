// The shipped scenes as they are, each compiled once for all tests of the folder.
#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>

namespace trocar {

/// @param name  of its folder in scenes/
inline const sim::Model& shipped(const std::string& name) {
  static std::map<std::string, sim::Model> compiled;
  const auto known = compiled.find(name);
  if (known != compiled.end()) return known->second;
  return compiled.emplace(name, scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/" + name + "/scene.json")))
      .first->second;
}

/// The names of all, in the order of the alphabet.
inline std::vector<std::string> shipped_scenes() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(TROCAR_SOURCE_DIR "/scenes"))
    if (std::filesystem::exists(entry.path() / "scene.json")) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace trocar
