// Files of operating rooms (scenes/rooms/*.json) and of programmes for their arms. Every fault of a file, and of the
// mechanisms and the scene that a room names, is reported with its place in one pass.
//
//   const Room room = read_room("scenes/rooms/telemanipulated.json");
//   const Programme programme = read_programme("scenes/rooms/programmes/triangle.json", room);
#pragma once

#include <filesystem>

#include <trocar/scene/json/shape.hpp>
#include <trocar/scene/operating_room/room.hpp>

namespace trocar::scene {

/// With the files that it names. @throws core::BadInput with all faults
Room read_room(const std::filesystem::path& path, const MemoryFiles* memory = nullptr);
/// JSON text alone: files that it names are not opened, so ports of its scene are not there.
Room parse_room(std::string_view text, const std::string& file, std::vector<core::Fault>& faults);

/// For a room: its arms are those of the room, its tilts within what the table can. @throws core::BadInput
Programme read_programme(const std::filesystem::path& path, const Room& room, const MemoryFiles* memory = nullptr);
/// @param room  null: names and tilts are not looked at
Programme parse_programme(std::string_view text, const std::string& file, const Room* room,
                          std::vector<core::Fault>& faults);

/// The tables of keys, from which scenes/schema/ is written.
const Shape& room_shape();
const Shape& programme_shape();

}  // namespace trocar::scene
