// STEP and IGES, by the program `trocar_cad`, which is built where Open CASCADE is installed.
#pragma once

#include <optional>
#include <vector>

#include <trocar/geometry/surfaces/tri_mesh.hpp>
#include <trocar/modeller/document/document.hpp>
#include <trocar/scene/json/json.hpp>

namespace trocar::modeller {

struct CadPart {
  int faces = 0;
  double unit = 1e-3;      ///< metres in the unit of the file's numbers, as it says
  geometry::TriMesh mesh;  ///< [m], as its faces were triangulated, each for itself
  std::optional<scene::JsonValue>
      nurbs;  ///< what it is exactly, as a body's file says it; none: no single closed surface
};

/// A Gmsh mesh, or a VTK file with tetrahedra. By its name's ending, then by its bytes.
bool is_tet_file(const fs::path& file);
/// By its name's ending.
bool is_cad_file(const fs::path& file);

/// Parts are as large as the file says.
/// @param within  how far meshes may be from their parts [m]
/// @param unit    that the file's numbers really are in, where it says another [m]: `within` holds for that
/// @throws core::BadInput for a file that cannot be read, core::EnvironmentLacks where the program is missing
std::vector<CadPart> read_cad_file(const fs::path& file, double within, std::optional<double> unit = {});

}  // namespace trocar::modeller
