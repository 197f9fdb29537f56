// A document that is moved, saved elsewhere or sent to somebody.
#include <trocar/geometry/surface_files/surface_writer.hpp>
#include <trocar/modeller/document/collect.hpp>
#include <trocar/modeller/document/home.hpp>
#include <trocar/modeller/operations/first_organ.hpp>

#include "workplace.hpp"

namespace trocar::modeller {
namespace {

/// A scene with an organ of its own, one from a file, and one in an organ file beside it.
Document with_files(const Workplace& place) {
  Document document = first_organ(place / "work/scene.json", "Mine");
  geometry::TriMesh mesh;
  mesh.positions = {{0, -0.15, -0.1}, {0.05, -0.15, -0.1}, {0, -0.1, -0.1}, {0, -0.15, -0.05}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  fs::create_directories(place / "work");
  std::ofstream(place / "tet.obj") << geometry::to_obj(mesh, 1e-3);
  apply(document, "from_file",
        R"({"file": "../tet.obj", "name": "tet", "tissue": "liver", "unit_mm": 1, "cell_mm": 3})");
  apply(document, "hold", R"({"of": "tet", "centre_mm": [10, -140, -90], "radius_mm": 8})");
  document.save();
  return document;
}

TEST(Collect, DocumentMovedToAnotherFolderStillCompiles) {
  const Workplace place;
  with_files(place);
  fs::create_directories(place / "far/away");
  fs::rename(place / "work", place / "far/away/moved");
  const Built built = build(Document::open(place / "far/away/moved/scene.json"));
  EXPECT_TRUE(built.good()) << (built.faults.empty() ? "" : core::to_string(built.faults.front()));
}

TEST(Collect, CopyToSendHoldsAllThatItNeeds) {
  const Workplace place;
  const Document document = with_files(place);
  const Collection copy = collected(document, place / "sent/scene.json");
  EXPECT_TRUE(copy.missing.empty());
  EXPECT_EQ(copy.copies.size(), 1u);
  write_collection(copy);
  fs::remove_all(place / "work");
  fs::rename(place / "sent", place / "received");
  const Built built = build(Document::open(place / "received/scene.json"));
  EXPECT_TRUE(built.good()) << (built.faults.empty() ? "" : core::to_string(built.faults.front()));
}

TEST(Collect, SaveElsewhereTakesImportedSurfacesAlong) {
  const Workplace place;
  Document document = with_files(place);
  fs::create_directories(place / "other");
  std::ofstream(place / "other/tet.stl") << "another file of this name";
  document.save_as(place / "other/mine.json");
  fs::remove_all(place / "work");
  EXPECT_EQ(read(place / "other/tet.stl"), "another file of this name");
  EXPECT_TRUE(build(Document::open(place / "other/mine.json")).good());
  EXPECT_TRUE(build(document).good());
}

TEST(Collect, TrainerGetsASceneOfAnOrganAlone) {
  const Workplace place;
  Document organ = begun(place / "organ.json", true, "mine");
  apply(organ, "ellipsoid",
        R"({"name": "ball", "tissue": "uterus", "centre_mm": [0, -150, -110], "half_mm": [20, 25, 20]})");
  apply(organ, "hold", R"({"of": "ball", "centre_mm": [0, -150, -122], "radius_mm": 11})");
  const fs::path scene = write_scene_for_trainer(organ, place / "operate");
  EXPECT_TRUE(build(Document::open(scene)).good());
}

TEST(Collect, InstalledFilesAreNotChangedThroughADocument) {
  const Workplace place;
  Document document = first_organ(place / "scene.json", "Mine");
  EXPECT_NE(fault_of(document, "move", R"({"of": ["port:umbilical"], "by_mm": [1, 0, 0]})"), "");
  EXPECT_EQ(document.done(), 0u);
}

}  // namespace
}  // namespace trocar::modeller
