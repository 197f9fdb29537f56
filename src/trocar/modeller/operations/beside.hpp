// Files that a document's bodies are made of: copies beside it, so that it can be moved and given away.
#pragma once

#include <string>
#include <string_view>

#include <trocar/geometry/surfaces/tri_mesh.hpp>
#include <trocar/modeller/document/document.hpp>

namespace trocar::modeller {

/// Puts the bytes into a file beside the document; its folder is made where it is missing. Where another file has that
/// name already it becomes NAME-2, NAME-3 ...: nothing is written over. One with the same content is taken as it is.
/// @return its name  @throws core::BadInput where it cannot be written
std::string put_beside(const Document& document, const std::string& stem, const std::string& extension,
                       std::string_view bytes);

/// What a body's file says of its surface: the mesh [m] goes into an STL file beside the document, about its own
/// middle, so that it is scaled about that. @throws core::BadInput as above
scene::JsonValue surface_beside(const Document& document, const std::string& name, const geometry::TriMesh& mesh,
                                Vec3d centre_mm);

}  // namespace trocar::modeller
