// What a scene compiles to and costs, and whether it is in equilibrium: `trocar check` of scenes, organs and exercises.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <trocar/core/json.hpp>
#include <trocar/sim/model/model.hpp>

namespace trocar::app {

/// Some ten seconds at most on a quiet machine: of a heavy scene less is simulated, as follows from its counts, and the
/// result says how much. Times that are measured are notes beside the verdict.
/// @param only  names of the bodies to list; empty: all
/// @param fits  asked with the compiled scene: throws core::BadInput where something else is wrong with it
/// @throws core::BadInput
Json describe_scene(const std::filesystem::path& path, const std::vector<std::string>& only,
                    const std::function<void(const sim::Model&)>& fits = {});

/// Does this file's list (of a scene `organs`, of an exercise `includes`) name that file?
bool lists_file(const std::filesystem::path& file, const char* list, const std::filesystem::path& wanted);

inline constexpr const char* kSinks = "not in equilibrium";
/// "good", "to mend" or kSinks.
std::string verdict_of(const Json& scene);

void print_scene(const Json& scene);

}  // namespace trocar::app
