// What an exercise is made of, and every fault that it has, also in its scene. Nothing is simulated for it.
#pragma once

#include <filesystem>

#include <trocar/core/json.hpp>

namespace trocar::app {

/// @throws core::BadInput with all faults of the exercise and of its scene, in one pass
Json describe_exercise(const std::filesystem::path& path);
void print_exercise(const Json& exercise);

}  // namespace trocar::app
