// Surfaces of triangles in and out of files: Wavefront OBJ, STL, PLY, static glTF 2.0 and legacy VTK polydata.
//
//   const SurfaceFile file = read_surface_file("organ.glb");   // or read_surfaces(bytes, "organ.glb")
//   for (const SurfacePart& part : file.parts) ...              // meshes with names
//   const TriMesh one = merged_equal(joined(file));             // seams closed where places are the same bits
//   if (file.metres == 0) ...                                   // unit_guess.hpp: what the extent suggests
//
// Read: OBJ (polygons, groups and objects, negative numbers), STL (text and binary, told apart by the size), PLY (text
// and binary of either byte order, any properties), glTF (.glb, and .gltf with embedded buffers or files beside it;
// triangles, strips and fans; nodes' transforms; sparse accessors), VTK (POLYDATA, and faces in UNSTRUCTURED_GRID, as
// text or binary). Coordinates are those of the file: nothing is scaled; where its head says that they are along the
// patient's axes (SPACE=LPS, RAS) they are turned into ours. Written: surface_writer.hpp.
//
// Files are taken as hostile: what they announce is believed as far as the bytes reach, never further.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <trocar/geometry/formats/patient_axes.hpp>
#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry {

/// Vertices, and triangles, of all parts together: a file of a kilobyte can name the same mesh at many places.
inline constexpr std::size_t kMostSurfaceItems = std::size_t(1) << 23;
/// Coordinates beyond this are a fault, so that areas and volumes stay finite [units of the file].
inline constexpr double kMostSurfaceCoordinate = 1e9;

struct SurfacePart {
  std::string name;  ///< as the file gave it, UTF-8; the file's own name where it gave none
  TriMesh mesh;      ///< corners are vertices that are there, coordinates finite
};

struct SurfaceFile {
  std::vector<SurfacePart> parts;        ///< at least one, none without triangles
  std::string format;                    ///< "STL, binary"
  std::vector<std::string> notes;        ///< what was left out: lines, skins, animations; what was turned
  double metres = 0;                     ///< in the file's unit where the file says so (glTF: 1; SPACE: 0.001), or 0
  bool has_unit_in_head = false;         ///< a line of its head names it: UNITS=in
  std::int64_t points = 0;               ///< of no triangle, as of a point cloud, or how many lists of them
  PatientAxes axes = PatientAxes::none;  ///< that the file names
};

/// The bytes of a file that lies beside the one that is read, by the name that stands in it.
using FilesBeside = std::function<std::string(const std::string& name)>;

/// Which format it is shows in the bytes. STL has no vertices of its own: corners at the same place are one.
/// @param path    for messages, and its stem for the name of a part without one
/// @param beside  may throw core::BadInput; without it buffers in other files are a fault
/// @throws core::BadInput with all faults, at most kMaxMeshFaults of them, at `path`
SurfaceFile read_surfaces(std::string_view bytes, const std::string& path, const FilesBeside& beside = {});
/// The same for a file; others are looked for in its folder, and nowhere else.
SurfaceFile read_surface_file(const std::filesystem::path& path);

/// "3 lines left out; 2 points left out": the first four and how many more.
std::string joined_notes(const std::vector<std::string>& notes);

/// All parts as one mesh, in their order, nothing merged.
TriMesh joined(const SurfaceFile& file);
/// Vertices at exactly the same place become the first of them; the order of what stays does not change.
TriMesh merged_equal(const TriMesh& mesh);

}  // namespace trocar::geometry
