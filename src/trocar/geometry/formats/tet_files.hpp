// Tetrahedral meshes in and out of files: Gmsh .msh and legacy VTK unstructured grids.
//
//   const TetFile file = read_tets(bytes, "liver.msh", 0.001);  // the file's unit is the millimetre
//   for (const std::string& note : file.notes) ...              // "860 triangles left out"
//   write(path, to_gmsh(file.mesh));
//
// Read: Gmsh 1 ($NOD, $ELM), 2.0-2.2, 4.0, 4.1, each as text or binary of either byte order; VTK legacy 1.0-5.x as text
// or (big-endian) binary, with cells in the old layout or as OFFSETS and CONNECTIVITY. Written: Gmsh 2.2 and VTK 4.2,
// as text, with so many digits that reading gives the same numbers back. Sources: Gmsh reference manual, "MSH file
// format" and its legacy formats; VTK file formats, "Simple legacy formats".
//
// Files are taken as hostile: what they announce is believed as far as the bytes reach, never further.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <trocar/geometry/formats/mesh_source.hpp>
#include <trocar/geometry/formats/patient_axes.hpp>
#include <trocar/geometry/tets/tet_mesh.hpp>

namespace trocar::geometry {

/// Coordinates beyond this are a fault, so that volumes and angles stay finite [m].
inline constexpr double kMaxCoordinate = 1e9;

struct TetFile {
  TetMesh mesh;
  std::string format;                    ///< "Gmsh 2.2, text"
  std::vector<std::string> notes;        ///< what was left out: other kinds of cells, nodes on edges; what was turned
  PatientAxes axes = PatientAxes::none;  ///< that the file names: its points are turned into ours
  double metres = 0;                     ///< in the file's unit, where the file says it; 0: it does not
};

/// Which format it is shows in the first bytes, not in the name. Tetrahedra of higher order give their corners.
/// Regions: Gmsh's physical group of the volume (0 where it has none); in VTK the cell array of whole
/// numbers that is called region, gmsh:physical or medit:ref.
/// @param scale  metres in the file's unit, > 0
/// @throws core::BadInput with all faults, at most kMaxMeshFaults of them, named `file`
TetFile read_tets(std::string_view bytes, const std::string& file, double scale = 1.0);

/// Is it a file of tetrahedra, and not of a surface? VTK files may be either.
bool holds_tetrahedra(std::string_view bytes);

/// The mesh as text, lengths in metres / scale. Regions are written where there are some.
std::string to_gmsh(const TetMesh& mesh, double scale = 1.0);
std::string to_vtk(const TetMesh& mesh, double scale = 1.0);

}  // namespace trocar::geometry
