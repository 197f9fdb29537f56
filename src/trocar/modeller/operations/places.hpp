// Where in a document's texts a new thing goes.
#pragma once

#include <string>

#include <trocar/modeller/operations/operation.hpp>

namespace trocar::modeller {

/// Puts it at the end of the list of its kind, which is made where it is lacking. Bodies of a scene go into the scene's
/// own organ, unless `file` (relative to the document) is named.
/// @throws core::BadInput for a name that is taken
void add_thing(Draft& draft, const std::string& kind, const scene::JsonValue& value, const std::string& file);

}  // namespace trocar::modeller
