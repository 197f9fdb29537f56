// Solids of tetrahedra in files: meshes, voxels and lofts that can be cut, and what is wrong with them.
#include <gtest/gtest.h>

#include <trocar/geometry/formats/tet_files.hpp>
#include <trocar/geometry/tets/stuffing.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/compile/mesh_cost.hpp>
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
  EXPECT_TRUE(o.faults(std::string(kSections) + R"(, "cell_mm": 3, "fibre": [1, 0, 0])").empty());
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

/// A ball of well-shaped cells, 30 mm across.
geometry::TetMesh ball() {
  const geometry::Field field{
      [](Vec3d p) { return 0.015 - length(p); }, {{-0.016, -0.016, -0.016}, {0.016, 0.016, 0.016}}, 1};
  return geometry::stuffed(field, 0.004);
}

/// The cell that is nearest to the middle, in four: a node in it, next to a corner, is their fourth.
geometry::TetMesh with_slivers(geometry::TetMesh mesh) {
  std::size_t inner = 0;
  const auto middle = [&](std::size_t c) {
    Vec3d sum;
    for (const int node : mesh.cells[c]) sum += mesh.points[std::size_t(node)] / 4.0;
    return sum;
  };
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    if (length(middle(c)) < length(middle(inner))) inner = c;
  const std::array<int, 4> cell = mesh.cells[inner];
  const Vec3d corner = mesh.points[std::size_t(cell[0])];
  mesh.points.push_back(corner + 0.0003 * (middle(inner) - corner));
  for (std::size_t k = 1; k < 4; ++k) mesh.cells.push_back(cell), mesh.cells.back()[k] = int(mesh.points.size()) - 1;
  mesh.cells[inner][0] = int(mesh.points.size()) - 1;
  return mesh;
}

Solid solid_of(const geometry::TetMesh& mesh, double refill = 0) {
  Solid s;
  s.tets = TetSource{};
  s.tets->file = "ball.msh";
  s.tets->mesh = mesh;
  s.tets->refill = refill;
  s.anchors.push_back({{0, 0, 0}, 0.05, 100, {}});
  return s;
}

TEST(TetSolid, AMeshWithSliversIsToldWithWhatItCostsAndTheKeyThatMendsIt) {
  const Tissue soft = small::tissue("soft", 30e3);
  const geometry::TetMesh good = ball(), bad = with_slivers(good);
  ASSERT_TRUE(geometry::inspect(bad).sound());
  const MeshCost as_it_is = cost_of(bad, soft), without = cost_of(good, soft);
  EXPECT_GT(as_it_is.substeps, 100) << "one cell in " << bad.cells.size();
  EXPECT_LT(without.substeps, kManySubsteps);
  const std::optional<Refill> refill = refill_of(bad, soft, as_it_is);
  ASSERT_TRUE(refill);
  EXPECT_NEAR(refill->cube, 0.004, 0.001);
  EXPECT_LT(4 * refill->cost.substeps, as_it_is.substeps);
  EXPECT_FALSE(refill_of(good, soft, without)) << "nothing to mend";

  CompileReport report;
  compile(with(solid_of(bad)), &report);
  const auto of_slivers = [](const CompileReport& r) {
    return std::count_if(r.warnings.begin(), r.warnings.end(),
                         [](const core::Fault& f) { return f.message.find("slivers") != std::string::npos; });
  };
  ASSERT_EQ(of_slivers(report), 1);
  for (const core::Fault& f : report.warnings)
    if (f.message.find("slivers") != std::string::npos) {
      EXPECT_NE(f.message.find("\"refill_mm\": "), std::string::npos) << f.message;
      EXPECT_NE(f.message.find(" sub-steps, about "), std::string::npos) << f.message;
    }
  CompileReport of_good;
  compile(with(solid_of(good)), &of_good);
  EXPECT_EQ(of_slivers(of_good), 0);
}

const char* const kSceneOfOrgan = R"({"format": 1, "name": "one", "organs": ["organ.json"],
  "tissues": [{"name": "liver", "density_kg_m3": 1060, "young_Pa": 5400, "source": "ours"}],
  "instruments": [{"name": "grasper", "kind": "grasper"}],
  "ports": [{"name": "a", "position_mm": [0, 0, 200], "diameter_mm": 10}, {"name": "b", "position_mm": [50, 0, 200]}],
  "tools": [{"instrument": "grasper", "port": "b", "tip_mm": [50, 0, 150]}],
  "scope": {"port": "a", "tip_mm": [0, 0, 150]}})";

TEST(TetSolid, ASurfaceIsFilledAnewByAKey) {
  Organ o;
  const geometry::TetMesh bad = with_slivers(ball());
  o.folder.write("slivers.msh", geometry::to_gmsh(bad, 0.001));
  const auto mesh_with = [&](const std::string& keys) {
    const std::filesystem::path organ = o.file(R"("mesh": {"file": "slivers.msh")" + keys + "}");
    const std::filesystem::path scene = o.folder.write("scene.json", kSceneOfOrgan);
    return read_scene(scene).solids.at(0).tets.value();
  };
  EXPECT_EQ(mesh_with("").mesh.cells.size(), bad.cells.size()) << "as it is";
  const TetSource filled = mesh_with(R"(, "refill_mm": 3.5)");
  EXPECT_DOUBLE_EQ(filled.refill, 0.0035);
  const geometry::TetFacts facts = geometry::inspect(filled.mesh), before = geometry::inspect(bad);
  EXPECT_LT(before.smallest_dihedral, 1);
  EXPECT_GT(facts.smallest_dihedral, kSliver);
  EXPECT_EQ(facts.odd_edges, 0);
  EXPECT_NEAR(facts.volume, before.volume, 0.03 * before.volume);
  EXPECT_TRUE(filled.warnings.empty()) << filled.warnings.front();
  const TetSource coarse = mesh_with(R"(, "refill_mm": 12)");
  ASSERT_EQ(coarse.warnings.size(), 1u) << geometry::inspect(coarse.mesh).volume / before.volume;
  EXPECT_NE(coarse.warnings[0].find("a smaller \"refill_mm\" keeps more"), std::string::npos) << coarse.warnings[0];
  expect_one(o.faults(R"("mesh": {"file": "two.msh", "refill_mm": 60})"), "smaller cells expected");
  expect_one(o.faults(R"("mesh": {"file": "two.msh", "refill_mm": -1})"), "refill_mm");
}

}  // namespace
}  // namespace trocar::scene
