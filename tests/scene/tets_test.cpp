// Solids of tetrahedra in files: meshes, voxels and lofts that can be cut, and what is wrong with them.
#include <gtest/gtest.h>

#include <trocar/geometry/formats/tet_files.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>

#include "../sim/small_scene.hpp"
#include "files.hpp"

namespace trocar::scene {
namespace {

/// Two cells on a triangle of 10 mm.
const char* const kMesh =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 10 0 0\n3 0 10 0\n4 0 0 10\n5 0 0 -10\n$EndNodes\n"
    "$Elements\n2\n1 4 2 0 1 1 2 3 4\n2 4 2 0 1 1 3 2 5\n$EndElements\n";

/// A ball of 8 voxels' radius, 1 mm each, label 3.
std::string ball_of_voxels() {
  constexpr int n = 20;
  std::string s =
      "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 20 20 20\nspace: left-posterior-superior\n"
      "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nencoding: raw\n\n";
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const int x = 2 * i - n + 1, y = 2 * j - n + 1, z = 2 * k - n + 1;
        s += x * x + y * y + z * z < 256 ? '\3' : '\0';
      }
  return s;
}

struct Organ {
  Folder folder;
  Organ() {
    folder.write("two.msh", kMesh);
    folder.write("ball.nrrd", ball_of_voxels());
    folder.write("broken.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 zero 0\n$EndNodes\n");
  }
  /// Messages of all faults of a solid with these keys.
  std::vector<std::string> faults(const std::string& keys) {
    std::vector<std::string> told;
    for (const core::Fault& f : check_file(file(keys))) told.push_back(f.message);
    return told;
  }
  std::filesystem::path file(const std::string& keys) {
    return folder.write("organ.json",
                        R"({"format": 1, "solids": [{"name": "body", "tissue": "liver", )" + keys + "}]}");
  }
};

const char* const kSections =
    R"("sections": [{"centre_mm": [0,0,0], "across_mm": [9,0,0], "deep_mm": [0,9,0]},
                    {"centre_mm": [0,0,9], "across_mm": [9,0,0], "deep_mm": [0,9,0]}])";

void expect_one(const std::vector<std::string>& faults, const std::string& part) {
  ASSERT_EQ(faults.size(), 1u) << (faults.empty() ? "" : faults.back());
  EXPECT_NE(faults[0].find(part), std::string::npos) << faults[0];
}

TEST(TetSolid, ShapesOfEveryKindAreRead) {
  Organ o;
  EXPECT_TRUE(o.faults(std::string(kSections) + R"(, "cell_mm": 3)").empty());
  EXPECT_TRUE(o.faults(std::string(kSections) + R"(, "cell_mm": 3, "cuttable": true, "fibre": [1, 0, 0])").empty());
  EXPECT_TRUE(o.faults(R"("mesh": {"file": "two.msh"}, "fibre": [0, 0, 1], "fibre_ratio": 2)").empty());
  EXPECT_TRUE(o.faults(R"("voxels": {"file": "ball.nrrd", "label": 3}, "cell_mm": 4)").empty());
}

TEST(TetSolid, OneShapeAndWhatBelongsToIt) {
  Organ o;
  expect_one(o.faults(R"("cell_mm": 3)"), "expected a shape");
  expect_one(o.faults(std::string(kSections)), "expected \"cell_mm\"");
  expect_one(o.faults(std::string(kSections) + R"(, "cell_mm": 3, "voxels": {"file": "ball.nrrd", "label": 3})"),
             "expected one shape, got a second one");
  expect_one(o.faults(R"("mesh": {"file": "two.msh"}, "cell_mm": 3)"), "no cell_mm beside a mesh");
  expect_one(o.faults(std::string(kSections) + R"(, "cell_mm": 3, "fibre": [1, 0, 0])"), "fibres in tetrahedra only");
  expect_one(o.faults(R"("mesh": {"file": "two.msh"}, "fibre": [0, 0, 0])"), "expected a direction");
  expect_one(o.faults(R"("mesh": {"file": "two.msh"}, "fine_edge_mm": 2)"), "skin edges for a lattice only");
}

TEST(TetSolid, FilesThatAreNotThereOrBrokenAreTold) {
  Organ o;
  expect_one(o.faults(R"("mesh": {"file": "none.msh"})"), "got none of this name");
  expect_one(o.faults(R"("mesh": {"file": "/etc/passwd"})"), "relative to this file");
  expect_one(o.faults(R"("voxels": {"file": "ball.nrrd", "label": 4}, "cell_mm": 4)"), "label");
  expect_one(o.faults(R"("voxels": {"file": "two.msh", "label": 4}, "cell_mm": 4)"), "expected");
  const std::vector<core::Fault> faults = check_file(o.file(R"("mesh": {"file": "broken.msh"})"));
  ASSERT_FALSE(faults.empty());
  EXPECT_NE(faults[0].at.file.find("broken.msh"), std::string::npos)
      << "where the mesh is wrong, not where it is named";
  EXPECT_EQ(faults[0].at.line, 6);
}

Description with(Solid solid) {
  Description d = small::description();
  solid.name = "body";
  solid.look = "liver";
  d.tissues.push_back(small::tissue("soft", 30e3));
  solid.tissue = "soft";
  d.solids.push_back(solid);
  return d;
}

TEST(TetSolid, AMeshIsANetworkOrCanBeCutAndWeighsWhatItsVolumeDoes) {
  for (const bool cuttable : {false, true}) {
    Solid s;
    s.tets = TetSource{};
    s.tets->mesh = geometry::read_tets(kMesh, "two.msh", 0.002).mesh;
    s.cuttable = cuttable;
    for (const Vec3d& corner : {Vec3d{0, 0, 0}, Vec3d{0.02, 0, 0}, Vec3d{0, 0.02, 0}})
      s.anchors.push_back({corner, 0.001, 0, {}});
    CompileReport report;
    const sim::Model m = compile(with(s), &report);
    EXPECT_EQ(m.organs(), 4);
    EXPECT_EQ(m.cuttables.size(), cuttable ? 2u : 1u);
    const auto body =
        std::find_if(report.bodies.begin(), report.bodies.end(), [](auto& b) { return b.name == "body"; });
    ASSERT_NE(body, report.bodies.end());
    EXPECT_EQ(body->nodes, 5);
    EXPECT_NEAR(body->mass, 1050 * 2 * 8e-6 / 6, 1e-6 * 1050 * 2 * 8e-6 / 6) << "density times volume";
  }
}

}  // namespace
}  // namespace trocar::scene
