// Formats that are not read, by name, so that a refusal says what to do.
#pragma once

#include <string>
#include <string_view>

namespace trocar::geometry {

/// What a file is that begins with these bytes, and the remedy: "VTK's XML format (.vtp, .vtu): save it as ...". Empty
/// for what is not known.
std::string foreign_format(std::string_view bytes);

}  // namespace trocar::geometry
