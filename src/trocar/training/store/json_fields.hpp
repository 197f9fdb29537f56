// Members of JSON objects that anybody may have written: what is missing or of another kind reads as nothing.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace trocar::training {

/// A member that is a text; empty where it is something else or not there, or `object` is no object.
/// @tparam AnyJson  nlohmann::json or ordered_json
template <class AnyJson>
std::string text_in(const AnyJson& object, const char* key) {
  const auto at = object.find(key);
  return at != object.end() && at->is_string() ? at->template get<std::string>() : std::string();
}

}  // namespace trocar::training
