// Where scenes and exercises are, and what the name that somebody typed means.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/scene/files/reader.hpp>

namespace trocar::attempt {

/// The folder `scenes` that comes with the program (scene::found_scenes_folder).
/// @throws core::EnvironmentLacks if there is none
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
/// The exercise files in the folders of `scenes` and of the user's own scenes (scene::own_scenes_folder): in the order
/// that their files say, then by name. Of two with one name the user's own.
std::vector<ExerciseEntry> list_exercises(const std::filesystem::path& scenes);
/// The same, and after them the scenes in which none of them is done.
std::vector<ExerciseEntry> list_trainings(const std::filesystem::path& scenes);
/// The scenes of both folders, by name; of two with one name the user's own.
std::vector<scene::SceneEntry> list_all_scenes(const std::filesystem::path& scenes);

/// What is wrong with an exercise's file and with where its scene is; empty: it can be begun.
std::vector<core::Fault> faults_of(const ExerciseEntry& exercise);

/// The file that EXERCISE means: a path, or a name under the user's own scenes or `scenes` ("gynaecology/EXERCISE", or
/// "gynaecology" for the bare scene).  @throws core::BadInput with what is there
std::filesystem::path find_exercise(const std::string& name, const std::filesystem::path& scenes);

/// Creates the folder and those above it.  @throws core::EnvironmentLacks
void make_folder(const std::filesystem::path& folder);

/// What Trocar keeps for this person (core::user_folder).
std::filesystem::path data_folder();

/// `path` itself if there is no such file, else "NAME-2.EXT", "NAME-3.EXT", ...
std::filesystem::path unused(const std::filesystem::path& path);

}  // namespace trocar::attempt
