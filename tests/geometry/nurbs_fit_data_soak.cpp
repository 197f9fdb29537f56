// Fits of NURBS to organs of an atlas, as its files have them: within a millimetre and two per cent of volume.
#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include <trocar/geometry/nurbs/mesh.hpp>
#include <trocar/geometry/nurbs_fit/fit.hpp>
#include <trocar/geometry/repair/mend.hpp>
#include <trocar/geometry/surface_files/surface_file.hpp>
#include <trocar/geometry/surfaces/groups.hpp>

namespace {

using namespace trocar;
namespace nurbs = trocar::geometry::nurbs;
using geometry::TriMesh;

const std::filesystem::path kAtlas = std::filesystem::path(TROCAR_SOURCE_DIR) / "../shared/data/anatomy/hubmap_ccf";

/// The parts of these names as one surface; all where there are none.
TriMesh parts_of_file(const std::filesystem::path& path, const std::vector<std::string>& names) {
  const geometry::SurfaceFile file = geometry::read_surface_file(path);
  EXPECT_EQ(file.metres, 1) << "glTF is in metres";
  TriMesh all;
  for (const geometry::SurfacePart& part : file.parts)
    if (names.empty() || std::find(names.begin(), names.end(), part.name) != names.end())
      geometry::append(all, part.mesh);
  return geometry::merged_vertices(all, 1e-6);
}

/// Of what hangs together the largest by area.
TriMesh largest_piece(const TriMesh& mesh) {
  geometry::Groups groups(mesh.positions.size());
  for (const auto& t : mesh.triangles) groups.join(t[0], t[1]), groups.join(t[1], t[2]);
  std::vector<double> area(mesh.positions.size());
  for (int t = 0; t < int(mesh.triangles.size()); ++t)
    area[std::size_t(groups.root(mesh.triangles[std::size_t(t)][0]))] += length(geometry::area_vector(mesh, t));
  const int largest = int(std::max_element(area.begin(), area.end()) - area.begin());
  TriMesh piece;
  std::vector<int> number(mesh.positions.size(), -1);
  for (const auto& t : mesh.triangles) {
    if (groups.root(t[0]) != largest) continue;
    std::array<int, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      int& n = number[std::size_t(t[k])];
      if (n < 0) n = int(piece.positions.size()), piece.positions.push_back(mesh.positions[std::size_t(t[k])]);
      corners[k] = n;
    }
    piece.triangles.push_back(corners);
  }
  return piece;
}

void expect_good_fit(const TriMesh& organ, const char* what) {
  nurbs::BodyFitOptions options;
  options.around = 16, options.along = 24;
  const nurbs::FitReport report = nurbs::fit_body(organ, options).report;
  std::printf("    %s: %zu vertices, rms %.3f mm, greatest %.2f, back %.3f, %.2f; %.3f of %.3f mL\n", what,
              organ.positions.size(), 1e3 * report.rms, 1e3 * report.greatest, 1e3 * report.back_rms,
              1e3 * report.back_greatest, 1e6 * report.volume_of_fit, 1e6 * report.volume_of_mesh);
  EXPECT_LT(report.rms, 0.001);
  EXPECT_LT(report.back_rms, 0.001) << "and nowhere does it bulge between the vertices";
  EXPECT_NEAR(report.volume_of_fit / report.volume_of_mesh, 1, 0.02);
}

class NurbsFitOfOrgans : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kAtlas)) GTEST_SKIP() << "the data folder " << kAtlas << " is absent";
  }
};

TEST_F(NurbsFitOfOrgans, AGallbladderIsWithinAMillimetre) {
  const TriMesh sack = parts_of_file(kAtlas / "VH_F_Gallbladder.glb", {});
  expect_good_fit(sack, "gallbladder");
}

TEST_F(NurbsFitOfOrgans, AUterusIsWithinAMillimetre) {
  const TriMesh open = largest_piece(parts_of_file(
      kAtlas / "VH_F_Uterus.glb",
      {"VH_F_fundus_of_uterus", "VH_F_cornua", "VH_F_body_of_uterus", "VH_F_lower_uterine_segment", "VH_F_cervix"}));
  const geometry::MendedMesh organ = geometry::mend(open);
  ASSERT_TRUE(organ.after.is_body());
  expect_good_fit(organ.mesh, "uterus");
}

}  // namespace
