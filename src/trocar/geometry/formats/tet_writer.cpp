// Tetrahedral meshes as text: Gmsh 2.2 and legacy VTK. Numbers have the fewest digits that read back as the same bits.

#include <fmt/format.h>

#include <trocar/geometry/formats/tet_files.hpp>

namespace trocar::geometry {
namespace {

std::string number(double value) { return fmt::format("{}", value); }

std::string point_text(Vec3d p, double scale) {
  return number(p.x / scale) + ' ' + number(p.y / scale) + ' ' + number(p.z / scale) + '\n';
}

}  // namespace

std::string to_gmsh(const TetMesh& mesh, double scale) {
  std::string out = fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", mesh.points.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    out += fmt::format("{} {}", i + 1, point_text(mesh.points[i], scale));
  out += fmt::format("$EndNodes\n$Elements\n{}\n", mesh.cells.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto& [a, b, d, e] = mesh.cells[c];
    const int region = mesh.region.empty() ? 0 : mesh.region[c];
    out += fmt::format("{} 4 2 {} {} {} {} {} {}\n", c + 1, region, region, a + 1, b + 1, d + 1, e + 1);
  }
  return out + "$EndElements\n";
}

std::string to_vtk(const TetMesh& mesh, double scale) {
  std::string out =
      fmt::format("# vtk DataFile Version 4.2\ntetrahedra\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {} double\n",
                  mesh.points.size());
  for (const Vec3d& p : mesh.points) out += point_text(p, scale);
  out += fmt::format("CELLS {} {}\n", mesh.cells.size(), 5 * mesh.cells.size());
  for (const auto& [a, b, c, d] : mesh.cells) out += fmt::format("4 {} {} {} {}\n", a, b, c, d);
  out += fmt::format("CELL_TYPES {}\n", mesh.cells.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) out += "10\n";
  if (mesh.region.empty()) return out;
  out += fmt::format("CELL_DATA {}\nSCALARS region int 1\nLOOKUP_TABLE default\n", mesh.cells.size());
  for (const int region : mesh.region) out += fmt::format("{}\n", region);
  return out;
}

}  // namespace trocar::geometry
