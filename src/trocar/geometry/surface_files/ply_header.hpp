// What a PLY file announces: elements in the order in which they follow, each with properties.
//
//   ply / format ascii 1.0 / comment ... / element vertex 8 / property float x / ... /
//   element face 6 / property list uchar int vertex_indices / end_header
//
// [Turk 1994, "The PLY polygon file format"]. Used by ply_reader.cpp only.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <trocar/geometry/formats/mesh_source.hpp>
#include <trocar/geometry/surface_files/surface_file.hpp>

namespace trocar::geometry {

/// How a number stands in binary files.
struct PlyType {
  int width = 0;
  bool whole = false, is_signed = false;
};

struct PlyProperty {
  std::string name;
  bool is_list = false;
  PlyType length;  ///< of a list
  PlyType type;
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::size_t at = 0;  ///< where the file says so
  std::vector<PlyProperty> properties;

  const PlyProperty* find(std::string_view name_of_property) const;
};

struct PlyHeader {
  MeshSource::Form form = MeshSource::Form::text;
  SurfaceFile head;  ///< what comments say of axes and of the unit
  std::vector<PlyElement> elements;
};

/// Up to and with the line end_header. No element has more items than bytes follow, one without properties has none.
PlyHeader read_ply_header(MeshSource& in);

}  // namespace trocar::geometry
