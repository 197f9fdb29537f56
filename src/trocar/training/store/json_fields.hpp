// Members of JSON objects that anybody may have written: what is missing or of another kind reads as nothing.
#pragma once

#include <string>

#include <trocar/core/json.hpp>

namespace trocar::training {

/// A member that is a text; empty where it is something else or not there, or `object` is no object.
/// @tparam AnyJson  nlohmann::json or ordered_json
template <class AnyJson>
std::string text_in(const AnyJson& object, const char* key) {
  const auto at = object.find(key);
  return at != object.end() && at->is_string() ? at->template get<std::string>() : std::string();
}

/// A text of anybody as JSON. What lies deeper than 64 levels is left out, as writing it would go as deep into the
/// stack. Discarded where the text is none.
inline Json json_in(const std::string& text) {
  constexpr int kDeepest = 64;
  return Json::parse(
      text, [](int depth, Json::parse_event_t, Json&) { return depth <= kDeepest; }, false);
}

}  // namespace trocar::training
