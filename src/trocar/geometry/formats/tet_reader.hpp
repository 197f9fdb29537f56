// What the readers of the formats share: coordinates that are checked, and a count of what is left out. Used by
// gmsh_*.cpp, vtk_tets.cpp and tet_files.cpp only.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include <trocar/geometry/formats/tet_files.hpp>

namespace trocar::geometry {

TetFile read_gmsh(MeshSource& in, double scale);
TetFile read_vtk(MeshSource& in, double scale);

/// A coordinate [m], checked; a fault at `at` and 0 where it is too large.
double checked_tet_coordinate(MeshSource& in, std::size_t at, const char* what, double metres);
/// Three coordinates, each of `width` bytes where binary. False: a fault, told already.
bool read_point(MeshSource& in, int width, double scale, Vec3d& point);

/// "3 triangles left out" and "4 tetrahedra of 10 nodes: their corners only".
class LeftOut {
 public:
  void cell(const std::string& kinds) { ++m_cells[kinds]; }  ///< in the plural
  void middle_nodes(int nodes) { ++m_higher[nodes]; }        ///< of a tetrahedron of so many nodes
  std::vector<std::string> notes() const;
  /// For a fault: what there is instead of tetrahedra.
  std::string instead() const;

 private:
  std::map<std::string, std::int64_t> m_cells;
  std::map<int, std::int64_t> m_higher;
};

}  // namespace trocar::geometry
