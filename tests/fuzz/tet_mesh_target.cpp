// The readers of tetrahedral meshes, the repair of what they read, its surface, and the writers.
#include <cmath>

#include <trocar/core/error.hpp>
#include <trocar/geometry/formats/tet_files.hpp>

#include "../geometry/mesh_bytes.hpp"
#include "targets.hpp"

namespace trocar::fuzz {
namespace {

using namespace geometry;

void check(const TetMesh& mesh) {
  require(!mesh.cells.empty(), "a mesh that was read has cells");
  require(mesh.region.empty() || mesh.region.size() == mesh.cells.size(), "regions are those of cells");
  for (const auto& cell : mesh.cells)
    for (const int node : cell)
      require(node >= 0 && node < int(mesh.points.size()), "corners are nodes that are there");
  for (const Vec3d& p : mesh.points)
    for (int k = 0; k < 3; ++k) require(std::fabs(p[k]) <= kMaxCoordinate, "coordinates are bounded");
}

bool finite(const TetFacts& f) {
  return std::isfinite(f.volume) && std::isfinite(f.smallest_volume) && std::isfinite(f.largest_volume) &&
         f.smallest_dihedral >= 0 && f.smallest_dihedral <= 90;
}

void check_repair(const TetMesh& mesh) {
  const TetFacts before = inspect(mesh);
  const TetRepair once = repair(mesh);
  const TetFacts after = inspect(once.mesh);
  require(finite(before) && finite(after), "facts are finite");
  require(after.sound() && after.crowded_faces == 0, "what was mended is sound");
  require(before.sound() == once.mended.empty(), "what is sound is left alone, what is not is told");
  require(repair(once.mesh).mended.empty(), "mending twice is mending once");
  require(check_edges(surface_of(once.mesh).mesh).open == 0, "the surface has no border");
}

void check_files(const TetMesh& mesh) {
  for (const std::string& text : {to_gmsh(mesh), to_vtk(mesh)}) {
    const TetMesh back = read_tets(text, "again").mesh;
    require(back.points == mesh.points && back.cells == mesh.cells, "what was read can be written and read again");
    if (!mesh.region.empty()) require(back.region == mesh.region, "with its regions");
  }
}

}  // namespace

void tet_mesh_file(Bytes bytes) {
  TetFile file;
  try {
    file = read_tets(text_of(bytes), "memory.msh");
  } catch (const core::BadInput& bad) {
    require(!bad.faults().empty() && bad.faults().size() <= kMaxMeshFaults + 1, "faults are bounded");
    for (const core::Fault& f : bad.faults()) require(!f.message.empty(), "a fault says what was expected");
    return;
  }
  check(file.mesh);
  check_repair(file.mesh);
  check_files(file.mesh);
}

std::vector<Seed> tet_mesh_seeds() {
  return {{"gmsh-1", bytes_of(kGmsh1)},
          {"gmsh-2", bytes_of(kGmsh2)},
          {"gmsh-2-binary", bytes_of(gmsh2_binary(false))},
          {"gmsh-2-swapped", bytes_of(gmsh2_binary(true))},
          {"gmsh-4.0", bytes_of(kGmsh40)},
          {"gmsh-4.0-binary", bytes_of(gmsh40_binary(false))},
          {"gmsh-4.1", bytes_of(kGmsh41)},
          {"gmsh-4.1-binary", bytes_of(gmsh41_binary(false))},
          {"gmsh-4.1-swapped", bytes_of(gmsh41_binary(true))},
          {"marked", bytes_of("\xef\xbb\xbf" + kGmsh2 + "\x1a")},
          {"slicer", bytes_of("# vtk DataFile Version 4.2\rSPACE=RAS\rASCII\rDATASET UNSTRUCTURED_GRID\rPOINTS 4 int\r"
                              "0 0 0 1 0 0 0 1 0 0 0 1 # corners\rCELLS 1 5\r4 0 1 2 3\rCELL_TYPES 1\r10\r")},
          {"vtk-3", bytes_of(kVtk)},
          {"vtk-3-binary", bytes_of(vtk_binary())},
          {"vtk-5", bytes_of(kVtk5)},
          {"vtk-5-binary", bytes_of(vtk5_binary())}};
}

std::vector<std::string> tet_mesh_words() {
  return {"$MeshFormat\n",
          "$EndMeshFormat\n",
          "$Nodes\n",
          "$ParametricNodes\n",
          "$EndParametricNodes\n",
          "$EndNodes\n",
          "$Elements\n",
          "$EndElements\n",
          "$Entities\n",
          "$EndEntities\n",
          "$NOD\n",
          "$ENDNOD\n",
          "$ELM\n",
          "$ENDELM\n",
          "2.2 0 8\n",
          "2.2 1 8\n",
          "4.0 0 8\n",
          "4.1 0 8\n",
          "4.1 1 8\n",
          " 4 2 1 1 ",
          " 11 ",
          "POINTS ",
          " float\n",
          "CELLS ",
          "CELL_TYPES ",
          "OFFSETS ",
          "CONNECTIVITY ",
          "vtktypeint64\n",
          "POINT_DATA ",
          "CELL_DATA ",
          "SCALARS region int\n",
          "LOOKUP_TABLE default\n",
          "FIELD FieldData 1\n",
          "VECTORS v float\n",
          "METADATA\n",
          "unsigned_char",
          "BINARY\n",
          "ASCII\n",
          "DATASET UNSTRUCTURED_GRID\n",
          "1e-308",
          "1e9",
          "-1e9",
          "nan",
          "2147483648",
          "-1",
          "9223372036854775807",
          "\r\n",
          "\r",
          "#",
          "SPACE=LPS\n",
          "string\n",
          "\xef\xbb\xbf"};
}

}  // namespace trocar::fuzz
