// Tetrahedra of the data folder: their nodes, cells and volumes, and that they are sound once repaired.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/geometry/formats/tet_files.hpp>

#include "tets.hpp"

namespace trocar::geometry {
namespace {

namespace fs = std::filesystem;

const fs::path kShared = fs::path(TROCAR_SOURCE_DIR) / "../shared/data/anatomy";

class SharedMesh : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kShared)) GTEST_SKIP() << "the data folder " << kShared << " is absent";
  }
  static std::string bytes_of(const std::string& name) {
    std::stringstream text;
    text << std::ifstream(kShared / name, std::ios::binary).rdbuf();
    return text.str();
  }
  static TetFile file(const std::string& name, double scale = 1) { return read_tets(bytes_of(name), name, scale); }
};

using Notes = std::vector<std::string>;

}  // namespace

TEST_F(SharedMesh, TheLiverOfVersion1HasItsNodesCellsAndVolume) {
  const TetFile liver = file("sofa/liver.msh");
  const TetFacts f = inspect(liver.mesh);
  EXPECT_EQ(liver.format, "Gmsh 1, text");
  EXPECT_EQ(f.nodes, 181);
  EXPECT_EQ(f.cells, 596);
  EXPECT_NEAR(f.volume, 36.561, 5e-4);
  EXPECT_TRUE(inspect(repair(liver.mesh).mesh).sound());
}

TEST_F(SharedMesh, TheFinerLiverHasNumbersWithGapsAndSurfaceElements) {
  const TetFile liver = file("sofa/liver2.msh");
  EXPECT_EQ(liver.mesh.points.size(), 507u);
  EXPECT_EQ(liver.mesh.cells.size(), 1493u);
  EXPECT_EQ(liver.notes, (Notes{"71 lines left out", "860 triangles left out"}));
}

TEST_F(SharedMesh, TheGallbladderInMillimetresHoldsItsMillilitres) {
  const TetFile file = SharedMesh::file("sofa_env_scenes/gallbladder_volumetric.vtk", 0.001);
  const TetFacts f = inspect(file.mesh);
  EXPECT_EQ(file.format, "VTK 4.2, binary");
  EXPECT_EQ(f.nodes, 367);
  EXPECT_EQ(f.cells, 1063);
  EXPECT_EQ(f.unused_nodes, 1);
  EXPECT_NEAR(f.volume * 1e6, 34.1, 0.05);
  EXPECT_EQ(file.mesh.region.size(), file.mesh.cells.size());
}

TEST_F(SharedMesh, SmallScenesHaveTheirNodesAndCells) {
  const std::tuple<const char*, std::size_t, std::size_t> expected[] = {
      {"sofa_env_scenes/liver_volumetric.vtk", 98, 273},
      {"sofa_env_scenes/tissue_volume.msh", 493, 1432},
      {"sofa_env_scenes/tissue_volumetric.msh", 145, 348}};
  for (const auto& [name, nodes, cells] : expected) {
    SCOPED_TRACE(name);
    const TetMesh mesh = file(name).mesh;
    EXPECT_EQ(mesh.points.size(), nodes);
    EXPECT_EQ(mesh.cells.size(), cells);
  }
}

TEST_F(SharedMesh, EveryMeshIsSoundOnceMendedClosedAndOfTheSameVolume) {
  for (const char* name : {"sofa/liver.msh", "sofa/liver2.msh", "sofa_env_scenes/gallbladder_volumetric.vtk",
                           "sofa_env_scenes/liver_volumetric.vtk", "sofa_env_scenes/tissue_volume.msh",
                           "sofa_env_scenes/tissue_volumetric.msh"}) {
    SCOPED_TRACE(name);
    const TetMesh mesh = file(name).mesh;
    const TetMesh good = repair(mesh).mesh;
    const TetFacts facts = inspect(good);
    EXPECT_TRUE(facts.sound());
    EXPECT_NEAR(facts.volume, inspect(mesh).volume, 1e-9 * facts.volume);
    EXPECT_NEAR(volume(surface_of(good).mesh), facts.volume, 1e-9 * facts.volume);
    EXPECT_EQ(check_edges(surface_of(good).mesh).open, 0);
    EXPECT_EQ(read_tets(to_gmsh(good), "again").mesh.points, good.points);
    EXPECT_EQ(read_tets(to_vtk(good), "again").mesh.cells, good.cells);
  }
}

TEST_F(SharedMesh, ASurfaceInVtkIsRefusedWithItsPlace) {
  try {
    file("sofa/liver.vtk");
    FAIL();
  } catch (const core::BadInput& bad) {
    EXPECT_STREQ(bad.what(), "sofa/liver.vtk:4:9: expected UNSTRUCTURED_GRID, as tetrahedra need, got 'POLYDATA'");
  }
}

TEST_F(SharedMesh, RealFilesCutOffAnywhereNeverCrash) {
  for (const char* name : {"sofa_env_scenes/liver_volumetric.vtk", "sofa_env_scenes/tissue_volumetric.msh"}) {
    const std::string bytes = bytes_of(name);
    for (std::size_t size = 0; size < bytes.size(); size += 97) {
      try {
        read_tets(bytes.substr(0, size), name);
      } catch (const core::BadInput&) {
      }
    }
  }
}

}  // namespace trocar::geometry
