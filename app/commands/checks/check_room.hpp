// What `trocar check` says of operating rooms and of programmes for their arms.
#pragma once

#include <filesystem>
#include <string>

#include <trocar/core/json.hpp>
#include <trocar/scene/json/json.hpp>

namespace trocar::app {

/// By its keys.
bool is_room_file(const scene::JsonValue& root);
bool is_programme_file(const scene::JsonValue& root);

/// How it stands: arms at their ports, clear, within reach of set-up joints. @throws core::BadInput with all faults
Json describe_room(const std::filesystem::path& path);
/// For the room among the files in the folder above, or beside it, whose arms it moves; gone through, fault by fault.
/// @throws core::BadInput with all faults, of the room that it fits best
Json describe_programme(const std::filesystem::path& path);
void print_room(const Json& checked);

}  // namespace trocar::app
