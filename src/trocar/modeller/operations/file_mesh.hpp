// Meshes of other programs' files as bodies: in metres, closed, with what is worth telling about them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <trocar/geometry/surface_files/surface_file.hpp>
#include <trocar/geometry/surface_files/unit_guess.hpp>
#include <trocar/modeller/operations/operation.hpp>

namespace trocar::modeller {

struct FileMesh {
  geometry::TriMesh mesh;          ///< [m] closed, outwards
  std::vector<std::string> notes;  ///< what was guessed, left out and mended
};

/// The mesh as a body. Changes are added to `notes`. @throws core::BadInput with what keeps it from being one
geometry::TriMesh mended(const fs::path& path, const geometry::TriMesh& mesh, std::vector<std::string>& notes);

/// The parts of a file that are asked for, joined; where `part` names none a fault through `o`, and no triangles.
geometry::TriMesh chosen_parts(const scene::JsonObject& o, const geometry::SurfaceFile& file);

/// Metres in the unit of an extent's coordinates: what the key unit_mm says, else what the file says or its size
/// suggests, which is added to `notes`. Where somebody must choose it is a fault through `o`, and nothing.
/// @param said  metres, where the file says so, else 0
std::optional<double> chosen_unit(const scene::JsonObject& o, const geometry::Extent& extent, double said,
                                  std::vector<std::string>& notes);

/// A file of triangles, by the keys part and unit_mm. Nothing, and a fault through `o`, where one of them must be
/// another. @throws core::BadInput
std::optional<FileMesh> mesh_from_file(const scene::JsonObject& o, const fs::path& path);

}  // namespace trocar::modeller
