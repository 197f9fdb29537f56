// A patient's scan: read, measured, segmented, and organs made of it that can be grasped and cut.
#include <cmath>
#include <fstream>

#include <trocar/modeller/document/home.hpp>
#include <trocar/modeller/drive/built.hpp>
#include <trocar/modeller/scan/segment_organ.hpp>
#include <trocar/modeller/script/session.hpp>
#include <trocar/volumes/files/volume_writer.hpp>
#include <trocar/volumes/segment/threshold.hpp>

#include "../full_disk.hpp"
#include "../volumes/dicom_bytes.hpp"
#include "workplace.hpp"

namespace trocar::modeller {
namespace {

/// A box of water with a ball of contrast agent in it, written as NRRD.
fs::path phantom(const Workplace& place, double radius_mm) {
  volumes::Volume v;
  v.grid.size = {48, 44, 40};
  v.grid.spacing = {1.5, 1.5, 2};
  v.grid.origin = {-36, 100, -60};
  v.stored.assign(v.grid.count(), 0);
  const Vec3d middle = v.grid.to_patient({24, 22, 20});
  for (std::size_t i = 0; i < v.grid.count(); ++i) {
    const volumes::Index3 at = v.grid.place(i);
    const Vec3d p = v.grid.to_patient({double(at[0]), double(at[1]), double(at[2])});
    v.stored[i] = length(p - middle) < radius_mm ? 200 : 0;
  }
  volumes::write_volume(place / "phantom.nrrd", v);
  return place / "phantom.nrrd";
}

TEST(Scan, ChangesOfSegmentsAreUndoneAtTheCostOfWhatWasChanged) {
  const Workplace place;
  Scan scan = Scan::open(phantom(place, 20));
  const std::uint16_t ball = scan.segment("ball");
  scan.change("threshold", volumes::thresholded(scan.volume(), scan.labels(), {100, 300}, ball));
  const double ml = volumes::millilitres(scan.labels(), ball);
  EXPECT_NEAR(ml, 4.0 / 3 * M_PI * 8, 0.4);
  EXPECT_LT(scan.history_bytes(), scan.labels().at.size());  // a byte a voxel would be a copy of half of it
  EXPECT_TRUE(scan.undo());
  EXPECT_EQ(volumes::millilitres(scan.labels(), ball), 0);
  EXPECT_TRUE(scan.redo());
  EXPECT_EQ(volumes::millilitres(scan.labels(), ball), ml);
}

/// Two phases in one folder: the script says which, and segments stay where another phase is opened.
TEST(Scan, AStepChoosesAPhaseAndSegmentsStayWithAnotherOne) {
  const Workplace place;
  for (int i = 0; i < 6; ++i) {
    volumes::DicomFile file;
    file.position = "0\\0\\" + std::to_string(2 * (i % 3));
    file.object = "1.2." + std::to_string(i);
    file.more = {{0x00200012, "IS", std::to_string(1 + i / 3)}};
    file.pixel = [i](int) { return i < 3 ? 1064 : 1184; };
    std::ofstream(place / (std::to_string(i) + ".dcm"), std::ios::binary) << file.bytes();
  }
  Session session;
  const auto step = [&](const std::string& text) { run_step(json(text), "script", session); };
  const std::string scan = "{\"do\": \"scan\", \"file\": \"" + (place / "").generic_string() + "\"";
  step(scan + "}");
  EXPECT_EQ(session.said().back()["greatest"].get<double>(), 40);
  step(R"({"do": "threshold", "segment": "a", "from": 0, "to": 100})");
  const volumes::Labels drawn = session.scan().labels();
  step(scan + ", \"frame\": 1}");
  EXPECT_EQ(session.said().back()["least"].get<double>(), 160);
  EXPECT_TRUE(session.scan().take_labels(drawn).empty());
  EXPECT_EQ(session.scan().labels().at, drawn.at);
  EXPECT_THROW(step(scan + ", \"frame\": 2}"), core::BadInput);
  EXPECT_THROW(step(scan + ", \"series\": 2}"), core::BadInput);
}

TEST(Scan, AnOrganOfASegmentHasItsVolumeIsGraspedAndIsCut) {
  const Workplace place;
  const fs::path file = phantom(place, 24);
  Session session;
  const auto step = [&](const std::string& text) { run_step(json(text), "script", session); };
  step("{\"do\": \"scan\", \"file\": \"" + file.generic_string() + "\"}");
  step(R"({"do": "threshold", "segment": "ball", "from": 100, "to": 300})");
  step("{\"do\": \"new\", \"file\": \"" + (place / "scene.json").generic_string() + "\"}");
  step(R"({"do": "organ_from", "segment": "ball", "name": "ball", "tissue": "liver", "cuttable": true, "cell_mm": 7,
           "centre_mm": [0, -150, -115]})");
  step(R"({"do": "hold", "of": "ball", "centre_mm": [0, -150, -128], "radius_mm": 14})");
  step(R"({"do": "check", "seconds": 0.3})");
  const Json& bodies = session.said().back()["check"];
  EXPECT_NEAR(bodies[0]["volume_mL"].get<double>() / session.said()[2]["mL_of_segment"].get<double>(), 1, 0.02);
  EXPECT_LE(bodies[0]["substeps"].get<int>(), 12);
  step(R"({"do": "take", "at_mm": [4, -140, -93], "of": "ball"})");
  step(R"({"do": "pull", "by_mm": [0, 0, 6]})");
  EXPECT_GT(session.said().back()["pull_N"].get<double>(), 0.1);
  step(R"({"do": "let_go"})");
  const sim::State before = session.drive().state();
  step(R"({"do": "use", "instrument": "scissors", "at_mm": [-8, -142, -95]})");
  EXPECT_NE(session.drive().state().cuttables[0].version, before.cuttables[0].version);
}

TEST(Scan, ASegmentOfTwoPartsThatTouchByACornerOrNothingIsToldOrMended) {
  const Workplace place;
  Scan scan = Scan::open(phantom(place, 20));
  Document document = Document::fresh(place / "scene.json", "{\"format\": 1, \"name\": \"x\", \"solids\": []}\n");
  EXPECT_THROW(make_organ(document, scan, {"nothing", "a", "liver", "", 0, false, std::nullopt}), core::BadInput);
  EXPECT_EQ(document.version(), 0u);
}

TEST(Scan, AnOrganForWhichTheDiskHasNoRoomChangesNothing) {
  const Workplace place;
  Scan scan = Scan::open(phantom(place, 20));
  const std::uint16_t ball = scan.segment("ball");
  scan.change("threshold", volumes::thresholded(scan.volume(), scan.labels(), {100, 300}, ball));
  Document document = begun(place / "scene.json", false, "mine");
  const std::uint64_t version = document.version();
  const OrganWish wish{"ball", "ball", "liver", "", 5, false, Vec3d{0, -150, -110}};
  std::string said;
  {
    const test::FullDisk disk(4096);
    try {
      make_organ(document, scan, wish);
    } catch (const core::BadInput& bad) {
      said = bad.what();
    }
  }
  EXPECT_NE(said.find("ball.stl: expected a file that can be written"), std::string::npos) << said;
  EXPECT_EQ(document.version(), version);
  EXPECT_FALSE(fs::exists(place / "ball.stl"));
  EXPECT_FALSE(fs::exists(place / "ball.stl.part"));
  make_organ(document, scan, wish);
  EXPECT_TRUE(build(document).good());
}

TEST(Scan, ABranchingSegmentBecomesATreeOfVesselsWithItsRadii) {
  const Workplace place;
  volumes::Volume v;  // a Y of tubes, 3 and 2 mm thick in radius
  v.grid.size = {60, 40, 60};
  v.grid.spacing = {1, 1, 1};
  v.stored.assign(v.grid.count(), 0);
  const auto tube = [&](Vec3d a, Vec3d b, double radius) {
    for (std::size_t i = 0; i < v.grid.count(); ++i) {
      const volumes::Index3 at = v.grid.place(i);
      const Vec3d p{double(at[0]), double(at[1]), double(at[2])}, way = b - a;
      const double t = std::clamp(dot(p - a, way) / dot(way, way), 0.0, 1.0);
      if (length(p - a - way * t) <= radius) v.stored[i] = 200;
    }
  };
  tube({30, 20, 4}, {30, 20, 28}, 3);
  tube({30, 20, 28}, {12, 20, 52}, 2);
  tube({30, 20, 28}, {48, 20, 52}, 2);
  volumes::write_volume(place / "y.nrrd", v);
  Session session;
  const auto step = [&](const std::string& text) { run_step(json(text), "script", session); };
  step("{\"do\": \"scan\", \"file\": \"" + (place / "y.nrrd").generic_string() + "\"}");
  step(R"({"do": "threshold", "segment": "artery", "from": 100, "to": 300})");
  step("{\"do\": \"new\", \"file\": \"" + (place / "scene.json").generic_string() + "\"}");
  step(
      R"({"do": "vessels_from", "segment": "artery", "file": "artery.json", "name": "artery", "root_mm": [30, 4, -20], "move_mm": [-30, -150, -90]})");
  EXPECT_EQ(session.said().back()["vessels"].get<int>(), 3);
  step(R"({"do": "check", "seconds": 0})");
  const Thing trunk = thing_named(session.document(), "vessel:artery_1");
  const scene::JsonValue value = value_of(session.document(), trunk);
  EXPECT_NEAR(value.find("radius_mm")->value.number, 3, 0.7);
}

}  // namespace
}  // namespace trocar::modeller
