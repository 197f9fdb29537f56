// Surfaces as files: the text or bytes of OBJ, STL, PLY and legacy VTK. What is written reads back as the same parts,
// vertices and triangles (surface_file.hpp).
//
//   write(path, to_obj(parts));                // all parts, each an object with its name
//   write(path, to_stl(mesh, 0.001));          // in millimetres
//
// OBJ, PLY and VTK keep the bits of coordinates; STL has single precision, and no vertices without triangles.
#pragma once

#include <span>
#include <string>

#include <trocar/geometry/surface_files/surface_file.hpp>

namespace trocar::geometry {

/// @param scale  metres in the file's unit: coordinates are written divided by it
std::string to_obj(std::span<const SurfacePart> parts, double scale = 1);
std::string to_obj(const TriMesh& mesh, double scale = 1);
/// Binary, with normals.
std::string to_stl(const TriMesh& mesh, double scale = 1);
/// Binary, little-endian, coordinates as doubles.
std::string to_ply(const TriMesh& mesh, double scale = 1);
/// Text, as POLYDATA of version 4.2.
std::string to_polydata(const TriMesh& mesh, double scale = 1);

}  // namespace trocar::geometry
