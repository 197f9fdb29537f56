// Changes to JSON text that leave everything else as its author wrote it: comments, layout, the way numbers are
// written.
//
//   std::string text = core::read_file("uterus.json", kMaxJsonBytes);
//   text = json_set(text, "/solids/0/cell_mm", json_number(4));             // replaced, or added to the object
//   text = json_insert(text, "/solids/0/sections", 1, std::move(section));  // before the second one
//   text = json_remove(text, "/solids/0/anchors/2");
//
// A path is a JSON pointer [RFC 6901]. An edit of a text that has faults throws std::invalid_argument: nothing is
// guessed about a structure that cannot be read.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <trocar/scene/json/json.hpp>

namespace trocar::scene {

/// A path longer by one key or by one item.
std::string json_path(std::string_view path, std::string_view key);
std::string json_path(std::string_view path, std::size_t item);

/// The value at `path` ("" is the root); null where there is none.
const JsonValue* json_at(const JsonValue& root, std::string_view path);

/// The text with another value at `path`. Where it says the same already, the same text. A key that the object does not
/// have is put behind its last one, an item one behind the last is put there.
/// @throws std::invalid_argument where nothing can stand at `path`
std::string json_set(std::string_view text, std::string_view path, const JsonValue& value);

/// The same for many values, all of which are there.
std::string json_set_all(std::string_view text, std::vector<std::pair<std::string, JsonValue>> values);

/// The text with another item in the array at `array`, which it then stands at. @throws std::invalid_argument
std::string json_insert(std::string_view text, std::string_view array, std::size_t item, const JsonValue& value);

/// The text without a member or an item, and without the comment behind it on its line. @throws std::invalid_argument
std::string json_remove(std::string_view text, std::string_view path);

/// Do they say the same? Order of keys counts, places in files do not.
bool same_json(const JsonValue& a, const JsonValue& b);

}  // namespace trocar::scene
