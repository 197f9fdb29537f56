// What an exercise is made of, or the rules that several share, and every fault that it has, also in its scene. Nothing
// is simulated for it.
#pragma once

#include <filesystem>

#include <trocar/core/json.hpp>
#include <trocar/scene/json/json.hpp>

namespace trocar::app {

/// @throws core::BadInput with all faults of the exercise and of its scene, in one pass
Json describe_exercise(const std::filesystem::path& path);
void print_exercise(const Json& exercise);

/// Steps and errors that exercises share: a title, and neither a scene nor a name.
bool is_rules_file(const scene::JsonValue& root);
/// Rules ask for what only an exercise has (sets, limits): they are read as part of each shipped one that takes them.
/// @throws core::BadInput with all faults of the file itself that any of these meets
Json describe_rules(const std::filesystem::path& path);
void print_rules(const Json& rules);

}  // namespace trocar::app
