// Where scenes and exercises are, and what the name that somebody typed means.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace trocar::attempt {

/// The folder `scenes`: $TROCAR_SCENES, else beside the program (build/release/trocar, or PREFIX/bin with
/// PREFIX/share/trocar), else where it was compiled.  @throws core::EnvironmentLacks if there is none
std::filesystem::path scenes_folder();

struct ExerciseEntry {
  std::string name;  ///< "FOLDER/EXERCISE"
  std::string title;
  std::filesystem::path path;
  bool task = true;                  ///< false: a bare scene, for free practice
  int order = 1000;                  ///< in lists: those with less come first
  std::filesystem::path scene = {};  ///< of an exercise: in which it is done
  std::string group = {};            ///< one of training::kGroups; empty: the file names none
  int level = 0;                     ///< 1 beginner to training::kMostLevel; 0: of a bare scene
  std::string summary = {};
  double expert_time = 0, longest_time = 0, pass_mark = 0;  ///< [s], [s], of 100; 0: not known
  bool demonstrated = false;                                ///< the file has a demonstration
};
/// The exercise files in the folders of `scenes`: in the order that their files say, then by name.
std::vector<ExerciseEntry> list_exercises(const std::filesystem::path& scenes);
/// The same, and after them the scenes in which none of them is done.
std::vector<ExerciseEntry> list_trainings(const std::filesystem::path& scenes);

/// The file that EXERCISE means: a path, or a name under `scenes` ("gynaecology/EXERCISE", or "gynaecology" for
/// the bare scene).  @throws core::BadInput with what is there
std::filesystem::path find_exercise(const std::string& name, const std::filesystem::path& scenes);

/// Creates the folder and those above it.  @throws core::EnvironmentLacks
void make_folder(const std::filesystem::path& folder);

/// What Trocar keeps for this person (settings, sessions, recordings, reports): $TROCAR_DATA, else
/// $XDG_DATA_HOME/trocar, else ~/.local/share/trocar. Not made by this.
std::filesystem::path data_folder();

/// `path` itself if there is no such file, else "NAME-2.EXT", "NAME-3.EXT", ...
std::filesystem::path unused(const std::filesystem::path& path);

}  // namespace trocar::attempt
