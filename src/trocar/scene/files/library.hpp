// Which files a file may name: those of its own tree, and those of libraries that somebody declared. A scene that came
// from elsewhere thereby opens nothing else of the machine.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace trocar::scene {

/// The folder `scenes` that comes with the program: $TROCAR_SCENES, else beside the program (PREFIX/bin with
/// PREFIX/share/trocar, or build/release/trocar), else where it was compiled, else /usr/local/share/trocar or
/// /usr/share/trocar. None where there is no such folder.
std::optional<std::filesystem::path> found_scenes_folder();

/// The user's own scenes and exercises: `scenes` in the data folder (core::user_folder). It need not be there. Files in
/// it name those that come with the program as if they were in the same tree.
std::filesystem::path own_scenes_folder();

/// NAME.json in a folder of the user's own scenes, else of those that come with the program.
std::optional<std::filesystem::path> named_in_scenes(const std::string& name, const char* folder);
/// What can be named there, sorted.
std::vector<std::string> names_in_scenes(const char* folder);
/// A file's path, or the name of one in such a folder.
/// @param what  what such a file is called, without an article
/// @throws core::BadInput  with the nearest name, where there is neither
std::filesystem::path file_or_name(const std::string& given, const char* folder, const char* what);

/// What the files read from one file on may name.
class Library {
 public:
  /// The tree of `first` begins at the nearest folder above it that is called `scenes`, else in its own folder. Beside
  /// it stand the folder `scenes` and the folders of $TROCAR_LIBRARY (separated by ':').
  explicit Library(const std::filesystem::path& first);

  /// The file itself; where it is not there but lies in the first file's own tree, which is called `scenes`, the one at
  /// the same place in another tree of that name.
  std::filesystem::path located(const std::filesystem::path& file) const;
  /// Does the file lie in one of these folders, links followed?
  bool holds(const std::filesystem::path& file) const;
  /// The folders of this name in them (looks, mechanisms), the tree's first; last the program's own, also where
  /// $TROCAR_SCENES names others: instruments are of its steel and its make.
  std::vector<std::filesystem::path> folders(const char* name) const;
  /// "expected a file in TREE (its tree) or a library (TROCAR_LIBRARY), got "NAME""
  std::string refusal(const std::string& name) const;

 private:
  std::vector<std::filesystem::path> m_folders;  ///< canonical, the tree first
};

}  // namespace trocar::scene
