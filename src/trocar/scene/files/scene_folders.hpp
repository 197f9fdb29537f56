// The folders of scenes: the one that comes with the program (found_scenes_folder in library.hpp), and the user's own,
// whose files name those of the program as if both lay in the same tree.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace trocar::scene {

/// The user's own scenes and exercises: `scenes` in the data folder (core::user_folder). It need not be there.
std::filesystem::path own_scenes_folder();

/// The file itself; where it is not there but would lie in a tree called `scenes`, the one at the same place among the
/// scenes that come with the program.
std::filesystem::path located(const std::filesystem::path& file);

/// NAME.json in a folder of the user's own scenes, else of those that come with the program.
std::optional<std::filesystem::path> named_in_scenes(const std::string& name, const char* folder);
/// What can be named there, sorted.
std::vector<std::string> names_in_scenes(const char* folder);
/// A file's path, or the name of one in such a folder.
/// @param what  what such a file is called, without an article
/// @throws core::BadInput  with the nearest name, where there is neither
std::filesystem::path file_or_name(const std::string& given, const char* folder, const char* what);

}  // namespace trocar::scene
