// Kinds of files that are taken for volumes and are none, by their first bytes, so that a message can name them. Used
// by the readers only.
#pragma once

#include <string>
#include <string_view>

namespace trocar::volumes {

/// "a ZIP archive: unpack it and open the folder"; empty: nothing that is known.
std::string known_bytes(std::string_view bytes);

}  // namespace trocar::volumes
