// What a file with tetrahedra holds, what is wrong with the mesh, and what can be mended: for `trocar check`.
#pragma once

#include <filesystem>

#include <trocar/core/json.hpp>

namespace trocar::app {

/// By its name: .msh or .vtk, in small or large letters.
bool is_mesh_file(const std::filesystem::path& path);

/// @param unit  metres in the file's unit, > 0
/// @throws core::BadInput with all faults of the file
Json describe_mesh(const std::filesystem::path& path, double unit);

/// describe_mesh()'s facts in words, a paragraph of lines that are set in.
void print_mesh(const Json& mesh);

}  // namespace trocar::app
