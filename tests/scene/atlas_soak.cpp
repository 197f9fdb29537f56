// Organs of an atlas (the data folder) as bodies: from their surfaces, and with masses at the control points of a fit.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <trocar/geometry/nurbs_fit/fit.hpp>
#include <trocar/geometry/repair/mend.hpp>
#include <trocar/geometry/surface_files/surface_file.hpp>
#include <trocar/scene/compile/body_surface.hpp>

#include "../sim/small_scene.hpp"
#include "one_body.hpp"

namespace trocar::scene {
namespace {

namespace nurbs = geometry::nurbs;

class SurfacesOfAnAtlas : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Organs, SurfacesOfAnAtlas,
                         testing::Values("VH_F_Uterus.glb", "VH_F_Pancreas.glb", "VH_F_Gallbladder.glb"));

TEST_P(SurfacesOfAnAtlas, AreMendedFilledAndHangStillInFewSubSteps) {
  const auto path = std::filesystem::path(TROCAR_SOURCE_DIR) / "../shared/data/anatomy/hubmap_ccf" / GetParam();
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  OneBodyScene t;
  t.folder.write("organ.glb", text_of(path));
  const bool sack = std::string(GetParam()) == "VH_F_Gallbladder.glb";  // of two sides, a wall of a millimetre
  const std::string solid = fmt::format(
      R"("solids": [{{"name": "body", "tissue": "liver", "surface": {{"file": "organ.glb"}}, "cell_mm": {},
         "anchors": [{{"centre_mm": [0, 250, -50], "radius_mm": 400, "stiffness_N_m": 300}}])",
      sack ? 2 : 5);
  for (const char* filled : {"}]", R"(, "cuttable": true}])"}) {
    if (sack && filled[0] == ',') continue;  // cells of a millimetre: more than a solid may have
    CompileReport report;
    const sim::Model model = compile(read_scene(t.scene(solid + filled)), &report);
    EXPECT_LE(body_of(report).substeps, 12);
    EXPECT_FALSE(report.warnings.empty()) << "what was mended is told";
    EXPECT_LT(drift(model), 1e-5);
  }
}

struct Atlas {
  const char* file;
  int around, along;
};
class ControlPointsOfAnAtlas : public testing::TestWithParam<Atlas> {};
INSTANTIATE_TEST_SUITE_P(Organs, ControlPointsOfAnAtlas,
                         testing::Values(Atlas{"VH_F_Ovary_L.glb", 8, 10}, Atlas{"VH_F_Spleen.glb", 16, 24},
                                         Atlas{"VH_F_Pancreas.glb", 12, 16}));

TEST_P(ControlPointsOfAnAtlas, HangStillInFewSubSteps) {
  const auto path = std::filesystem::path(TROCAR_SOURCE_DIR) / "../shared/data/anatomy/hubmap_ccf" / GetParam().file;
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const geometry::TriMesh mesh =
      geometry::mend(geometry::merged_equal(geometry::joined(geometry::read_surface_file(path)))).mesh;
  nurbs::BodyFitOptions options;
  options.around = GetParam().around, options.along = GetParam().along;
  Description d = small::description();
  Solid s;
  s.name = s.look = "body";
  s.tissue = "flesh";
  s.shape.nurbs = shape_of(nurbs::fit_body(mesh, options).surface);
  s.masses = Masses::control_points;
  const Vec3d middle = geometry::centre_of_volume(mesh);
  for (Vec3d& p : s.shape.nurbs->net) p += Vec3d{0, 0, -0.5} - middle;
  s.cell = 0.010;
  s.skin_edge = 0.004, s.fine_edge = 0.003;
  s.anchors.push_back({{0, 0, -0.5}, 0.2, 300, {}});
  d.solids.push_back(s);
  CompileReport report;
  const sim::Model model = compile(d, &report);
  EXPECT_LE(body_of(report).substeps, 20);
  EXPECT_NEAR(body_of(report).volume / geometry::volume(mesh), 1, 0.03);
  EXPECT_LT(drift(model, model.organ_index("body")), 1e-5);
}

}  // namespace
}  // namespace trocar::scene
