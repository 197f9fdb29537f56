// What can be offered to somebody who wants to train, beyond paths.hpp.
#pragma once

#include <filesystem>
#include <vector>

#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/scene/files/reader.hpp>

namespace trocar::attempt {

/// The scenes of `scenes` and of the user's own folder, by name; of two with one name the user's own.
std::vector<scene::SceneEntry> list_all_scenes(const std::filesystem::path& scenes);

/// What is wrong with an exercise's file and with where its scene is; empty: it can be begun.
std::vector<core::Fault> faults_of(const ExerciseEntry& exercise);

}  // namespace trocar::attempt
