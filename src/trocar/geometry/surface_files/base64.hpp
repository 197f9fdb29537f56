// Bytes in text, as the data URIs of glTF hold them. [RFC 4648, section 4]
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace trocar::geometry {

/// Nothing where a character is none of base64's, or where something follows the padding; padding may be missing.
std::optional<std::string> from_base64(std::string_view text);

}  // namespace trocar::geometry
