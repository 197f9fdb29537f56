// What a document lacks to be operated on, and the remedies that mend it with one click.
#include <array>
#include <fstream>

#include <trocar/geometry/surface_files/surface_writer.hpp>
#include <trocar/modeller/document/collect.hpp>
#include <trocar/modeller/document/home.hpp>
#include <trocar/modeller/materials/materials.hpp>
#include <trocar/modeller/operations/first_organ.hpp>

#include "workplace.hpp"

namespace trocar::modeller {
namespace {

using About = Finding::About;

std::vector<Finding> findings_of(const Document& document) { return build(document).findings; }

/// Does the first finding's remedy. @return what that was about
About mend_first(Document& document) {
  const std::vector<Finding> findings = findings_of(document);
  EXPECT_FALSE(findings.empty());
  if (findings.empty()) return About::file;
  EXPECT_FALSE(findings.front().remedy.empty()) << findings.front().words;
  for (scene::JsonValue step : findings.front().steps) {
    const std::string name = step.members.front().value.text;
    step.members.erase(step.members.begin());
    modeller::apply(*find_operation(name), step, "remedy", document);
  }
  return findings.front().about;
}

TEST(Readiness, NewOrganCanBeOperatedOnAtOnce) {
  const Workplace place;
  const Document document = first_organ(place / "untitled.json", "Untitled");
  EXPECT_TRUE(findings_of(document).empty()) << findings_of(document).front().words;
  EXPECT_EQ(document.done(), 0u);
  EXPECT_NEAR(built_mL(document, "organ"), 34, 3);
}

TEST(Readiness, ExampleUterusCanBeOperatedOnAsACopyOfOnesOwn) {
  const Workplace place;
  const Document sample = Document::open(modelling_place().parent_path() / "uterus.json");
  const Collection copy = collected(sample, place / "mine.json");
  write_collection(copy);
  const Built built = build(Document::open(place / "mine.json"));
  EXPECT_TRUE(built.good());
  EXPECT_TRUE(built.findings.empty()) << built.findings.front().words;
}

TEST(Readiness, EmptySceneAsksForAnOrgan) {
  const Workplace place;
  const std::vector<Finding> findings = findings_of(begun(place / "scene.json", false, "empty"));
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].about, About::organ);
}

TEST(Readiness, RemediesAttachScaleAndBringIntoView) {
  const Workplace place;
  Document document = begun(place / "scene.json", false, "mine");
  apply(document, "ellipsoid",
        R"({"name": "bean", "tissue": "liver", "centre_mm": [900, 400, 300], "half_mm": [1.8, 2.5, 1.8]})");
  EXPECT_EQ(mend_first(document), About::attachment);
  EXPECT_EQ(mend_first(document), About::size);
  EXPECT_EQ(mend_first(document), About::view);
  EXPECT_TRUE(findings_of(document).empty());
  EXPECT_NEAR(built_mL(document, "bean"), 33.9, 3);
}

TEST(Readiness, HeavyOrganRestsOnItsUnderside) {
  const Workplace place;
  Document document = begun(place / "scene.json", false, "mine");
  apply(
      document, "ellipsoid",
      R"({"name": "slab", "tissue": "liver", "cell_mm": 14, "centre_mm": [0, -150, -200], "half_mm": [110, 20, 40]})");
  apply(document, "hold", R"({"of": "slab", "centre_mm": [-100, -150, -200], "radius_mm": 15})");
  EXPECT_FALSE(build(document).good());
  for (int clicks = 0; clicks < 3 && !findings_of(document).empty(); ++clicks)
    EXPECT_EQ(mend_first(document), About::attachment);
  EXPECT_TRUE(findings_of(document).empty());
  EXPECT_TRUE(build(document).good());
}

TEST(Readiness, UnknownTissueIsFoundWithItsName) {
  const Workplace place;
  Document document = first_organ(place / "scene.json", "Mine");
  apply(document, "set", R"({"of": "organ", "key": "tissue", "value": "cheese"})");
  const std::vector<Finding> findings = findings_of(document);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].about, About::tissue);
  EXPECT_NE(findings[0].words.find("cheese"), std::string::npos);
}

TEST(Readiness, OpenSurfaceThatMustNotBeMendedGetsItsHolesClosed) {
  const Workplace place;
  Document document = first_organ(place / "scene.json", "Mine");
  geometry::TriMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back(Vec3d{double(i & 1), double(i >> 1 & 1), double(i >> 2)} * 0.03 +
                             Vec3d{-0.015, -0.165, -0.125});
  for (const auto& [a, b, c, d] :
       {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
    mesh.triangles.push_back({a, b, c}), mesh.triangles.push_back({a, c, d});
  mesh.triangles.pop_back();
  std::ofstream(place / "open.obj") << geometry::to_obj(mesh, 1e-3);
  apply(document, "delete", R"({"of": ["organ"]})");
  apply(document, "add",
        R"({"kind": "solid", "value": {"name": "box", "tissue": "liver", "cell_mm": 5,
            "surface": {"file": "open.obj", "unit_mm": 1, "mend": false},
            "anchors": [{"centre_mm": [0, -150, -120], "radius_mm": 10}]}})");
  EXPECT_EQ(mend_first(document), About::surface);
  EXPECT_TRUE(findings_of(document).empty());
}

TEST(Readiness, ImportedSurfaceScalesAboutItsMiddle) {
  const Workplace place;
  Document document = begun(place / "scene.json", false, "mine");
  geometry::TriMesh mesh;
  mesh.positions = {{1, 1, 1}, {1.04, 1, 1}, {1, 1.04, 1}, {1, 1, 1.04}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  std::ofstream(place / "tet.obj") << geometry::to_obj(mesh, 1e-3);
  apply(document, "from_file",
        R"({"file": "tet.obj", "name": "tet", "tissue": "liver", "unit_mm": 1, "cell_mm": 3,
            "centre_mm": [0, -150, -110]})");
  const double before = built_mL(document, "tet");
  apply(document, "scale", R"({"of": ["tet"], "by": 2})");
  EXPECT_NEAR(built_mL(document, "tet") / before, 8, 1);
  std::vector<core::Fault> faults;
  const auto d = document.description(faults);
  const geometry::Bounds box = geometry::bounds(d->solids.back().shape.surface->mesh.positions);
  EXPECT_NEAR((box.low.y + box.high.y) / 2, -0.150, 1e-6);
  EXPECT_NEAR(box.high.x - box.low.x, 0.08, 1e-6);
}

TEST(Materials, NamesSuggestTissueAndMaterial) {
  const Workplace place;
  const std::vector<TissueChoice> tissues = tissue_choices(first_organ(place / "scene.json", "Mine"));
  EXPECT_EQ(tissue_for_name("liver-smooth", tissues), "liver");
  EXPECT_EQ(tissue_for_name("VH_F_Uterus", tissues), "uterus");
  EXPECT_EQ(tissue_for_name("VH_F_Gallbladder", tissues), "gallbladder_wall");
  EXPECT_EQ(tissue_for_name("something", tissues), "");
  EXPECT_EQ(material_for("liver-smooth", "uterus"), "liver_lifted");
  EXPECT_EQ(material_of_tissue("liver"), "liver_lifted");
  EXPECT_EQ(material_for("something", "gallbladder_wall"), "gallbladder");
  EXPECT_GT(material_choices().size(), 20u);
}

}  // namespace
}  // namespace trocar::modeller
