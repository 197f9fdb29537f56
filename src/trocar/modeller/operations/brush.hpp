// Where a brush's balls stand in a body's text.
#pragma once

#include <string>

#include <trocar/scene/json/json.hpp>

namespace trocar::modeller {

/// Path within the body's object.
/// @param kind   of the thing
/// @param what   "hold", "bonds" or "stiffness"
/// @param bonds  name of the bonds; empty: the first
/// @return empty: such a thing has none
std::string list_of_brush(const scene::JsonValue& body, const std::string& kind, const std::string& what,
                          const std::string& bonds);

}  // namespace trocar::modeller
