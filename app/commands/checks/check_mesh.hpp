// What a file of another program holds, its parts and size, what is wrong with them and what can be mended: for
// `trocar check`.
#pragma once

#include <filesystem>
#include <optional>

#include <trocar/core/json.hpp>

namespace trocar::app {

/// A file of tetrahedra, of triangles, STEP or IGES: by the ending of its name, in small or large letters.
bool is_mesh_file(const std::filesystem::path& path);

/// @param unit  metres in the file's unit, > 0; none: what the file says or its size suggests, which a note tells
/// @throws core::BadInput with all faults of the file, or where somebody must choose the unit
Json describe_mesh(const std::filesystem::path& path, std::optional<double> unit);

/// describe_mesh()'s facts in words, a paragraph of lines that are set in.
void print_mesh(const Json& mesh);

}  // namespace trocar::app
