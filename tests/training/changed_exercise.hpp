// A shipped exercise's file, changed as a test wants it, with the common rules that it includes. Nothing is written to
// the disk.
#pragma once

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <trocar/scene/json/json.hpp>

namespace trocar {

/// Where the changed file seems to be.
inline const char* const kChanged = "scenes/changed/exercise.json";

inline std::string text_of_scene_file(const std::string& name) {
  std::ifstream in(std::string(TROCAR_SOURCE_DIR "/scenes/") + name);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A text with the first occurrence of each `first` replaced by `second`.
inline std::string changed_text(std::string text, const std::vector<std::pair<std::string, std::string>>& changes) {
  for (const auto& [from, to] : changes) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) throw std::logic_error("the file does not say " + from);
    text.replace(at, from.size(), to);
  }
  return text;
}

inline const scene::MemoryFiles* files_with(const std::string& exercise) {
  static scene::MemoryFiles files = [] {
    scene::MemoryFiles all;
    for (const char* name : {"handling", "clips", "energy", "bleeding"})
      all[std::string("scenes/common/") + name + ".json"] = text_of_scene_file(std::string("common/") + name + ".json");
    return all;
  }();
  files[kChanged] = exercise;
  return &files;
}

/// To be read at once: read_exercise(kChanged, changed_exercise(...)).
inline const scene::MemoryFiles* changed_exercise(const std::string& name,
                                                  const std::vector<std::pair<std::string, std::string>>& changes) {
  return files_with(changed_text(text_of_scene_file(name), changes));
}

}  // namespace trocar
