// A legacy VTK file as far as meshes need it: POLYDATA or an UNSTRUCTURED_GRID, as text or big-endian binary.
//
//   # vtk DataFile Version 3.0 / title / ASCII or BINARY / DATASET UNSTRUCTURED_GRID
//   POINTS n float, POLYGONS n size, TRIANGLE_STRIPS ...           POLYDATA: each list its number of points, then these
//   POINTS n float, CELLS n size, CELL_TYPES n                     UNSTRUCTURED_GRID, the same
//   CELLS n+1 size / OFFSETS vtktypeint64 / CONNECTIVITY ...       from 5.0 on
//   FIELD, METADATA, POINT_DATA, CELL_DATA                         vtk_data.hpp
//
// [VTK file formats: Simple legacy formats; vtkDataReader of VTK 9 for what these leave open]. Used by the readers of
// surfaces and of tetrahedra.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <trocar/geometry/formats/vtk_data.hpp>
#include <trocar/geometry/formats/vtk_lists.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry {

class VtkDataset {
  MeshSource& m_in;
  VtkValues m_values;  // the lists below refer to it

 public:
  /// What is taken for a coordinate that stands at a place in the file.
  using Coordinate = std::function<double(std::size_t at, double value)>;

  /// Reads the file. @throws core::BadInput at what cannot be followed
  /// @param needs_grid  POLYDATA is a fault
  VtkDataset(MeshSource& in, bool needs_grid, const Coordinate& coordinate);
  VtkDataset(const VtkDataset&) = delete;
  VtkDataset& operator=(const VtkDataset&) = delete;

  const std::string& format() const { return m_format; }  ///< "VTK 3.0, text"
  PatientAxes axes() const;
  bool is_grid() const { return m_is_grid; }
  bool binary() const { return m_values.binary(); }

  std::vector<Vec3d> points;
  VtkLists cells, polygons, strips, lines, vertices;
  std::vector<std::int64_t> types;  ///< of cells, as many

  /// What cell c is, null where that is not known. A number of points that does not fit it is a fault.
  const VtkCell* type_of(std::size_t c);
  const std::vector<int>& regions() const { return m_data.regions(); }  ///< of all cells, or none
  /// The number of a point that list l names, or -1 and a fault where there is none.
  int point(const VtkLists& lists, std::size_t l, std::int64_t k);
  /// Adds where reading ended before the end of the file.
  void tell(std::vector<std::string>& notes) const;

 private:
  VtkData m_data;
  std::string m_format;
  PatientAxes m_axes = PatientAxes::none;  ///< as the title has it
  bool m_is_grid = false, m_has_points = false;

  void keyword(const Coordinate& coordinate);
  void read_points(std::size_t at, const Coordinate& coordinate);
  void read_lists(VtkLists& of, std::size_t at);
  void read_types();
  bool complete() const { return m_has_points && (!m_is_grid || !types.empty()); }
};

}  // namespace trocar::geometry
