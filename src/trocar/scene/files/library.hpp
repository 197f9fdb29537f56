// Which files a file may name: those of its own tree, and those of libraries that somebody declared. A scene that came
// from elsewhere thereby opens nothing else of the machine.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace trocar::scene {

/// The folder `scenes`: $TROCAR_SCENES, else beside the program (build/release/trocar, or PREFIX/bin with
/// PREFIX/share/trocar), else where it was compiled. None where there is no such folder.
std::optional<std::filesystem::path> found_scenes_folder();

/// How a document outside the installed folder `scenes` names a file of it; none for other files.
std::optional<std::string> name_in_installed_scenes(const std::filesystem::path& file);

/// What the files read from one file on may name.
class Library {
 public:
  /// The tree of `first` begins at the nearest folder above it that is called `scenes`, else in its own folder. Beside
  /// it stand the folder `scenes` and the folders of $TROCAR_LIBRARY (separated by ':').
  explicit Library(const std::filesystem::path& first);

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
