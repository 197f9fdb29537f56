// What a session writes: only where it was asked to, never over what is there unasked.
#include <trocar/geometry/surface_files/surface_writer.hpp>
#include <trocar/modeller/document/home.hpp>
#include <trocar/modeller/drive/built.hpp>
#include <trocar/modeller/script/session.hpp>

#include "workplace.hpp"

namespace trocar::modeller {
namespace {

constexpr const char* kBall = R"({"do": "ellipsoid", "name": "ball", "tissue": "uterus", "centre_mm": [0, -150, -110],
    "half_mm": [15, 20, 15], "cell_mm": 6})";

class Writing : public testing::Test {
 protected:
  void step(const std::string& text) { run_step(json(text), "script", session); }
  std::string fault_of(const std::string& text) {
    try {
      step(text);
    } catch (const core::BadInput& bad) {
      return bad.what();
    }
    return "";
  }
  std::string path(const std::string& name) const { return (place / name).generic_string(); }
  void begin(const std::string& name) { step(R"({"do": "new", "file": ")" + path(name) + "\"}"); }
  void write(const std::string& name, const std::string& bytes) {
    fs::create_directories((place / name).parent_path());
    std::ofstream(place / name, std::ios::binary) << bytes;
  }

  Workplace place;
  Session session;
};

/// A tetrahedron of 30 mm [mm].
geometry::TriMesh corner() {
  return {{{0, 0, 0}, {30, 0, 0}, {0, 30, 0}, {0, 0, 30}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

TEST_F(Writing, ANewDocumentTakesAMeshBeforeItsFolderIsThere) {
  write("corner.obj", geometry::to_obj(corner()));
  begin("fresh/scene.json");
  step(R"({"do": "from_file", "file": "../corner.obj", "name": "body", "tissue": "uterus"})");
  step(R"({"do": "save"})");
  EXPECT_TRUE(fs::exists(place / "fresh/body.stl"));
  EXPECT_TRUE(fs::exists(place / "fresh/scene.json"));
}

TEST_F(Writing, ABodysCopyDoesNotReplaceAFileThatIsThere) {
  const std::string own = geometry::to_stl(corner(), 0.001);
  write("body.stl", own);
  begin("scene.json");
  step(R"({"do": "from_file", "file": "body.stl", "name": "body", "tissue": "uterus", "unit_mm": 0.001})");
  EXPECT_EQ(read(place / "body.stl"), own);
  EXPECT_TRUE(fs::exists(place / "body-2.stl"));
  const scene::JsonValue body = value_of(session.document(), thing_named(session.document(), "body"));
  EXPECT_EQ(body.find("surface")->value.find("file")->value.text, "body-2.stl");
  step(R"({"do": "undo"})");
  step(R"({"do": "from_file", "file": "body.stl", "name": "body", "tissue": "uterus", "unit_mm": 0.001})");
  EXPECT_FALSE(fs::exists(place / "body-3.stl")) << "the same content is not written again";
}

TEST_F(Writing, SavingAsAndExportingReplaceAFileOnlyWhereTheStepSaysSo) {
  begin("scene.json");
  step(kBall);
  step(R"({"do": "save"})");
  for (const std::string text : {R"({"do": "save", "as": ")", R"({"do": "export", "of": "ball", "file": ")"}) {
    const std::string name = text.find("save") != text.npos ? "other.json" : "other.stl";
    write(name, "mine");
    const std::string fault = fault_of(text + path(name) + "\"}");
    EXPECT_NE(fault.find(name + "\", which exists: \"over\": true replaces it"), std::string::npos) << fault;
    EXPECT_EQ(read(place / name), "mine");
    step(text + path(name) + R"(", "over": true})");
    EXPECT_NE(read(place / name), "mine");
  }
  step(R"({"do": "save", "as": ")" + path("other.json") + "\"}");  // the document's own file
  step(R"({"do": "export", "of": "ball", "file": ")" + path("new/ball.obj") + "\"}");
  EXPECT_TRUE(fs::exists(place / "new/ball.obj"));
}

TEST_F(Writing, FilesOutsideTheDocumentsFolderAreRefused) {
  begin("mine/scene.json");
  const std::string tree = R"(", "name": "t", "vessel": "trunk", "path_mm": [[0, -150, -110], [0, -120, -110]],
      "radius_mm": 2, "flow_mL_min": 50})";
  for (const std::string name : {"../tree.json", "../../tree.json", "/tmp/tree.json"}) {
    const std::string fault = fault_of(R"({"do": "vessel_tree", "file": ")" + name + tree);
    EXPECT_NE(fault.find("expected a file in "), std::string::npos) << fault;
  }
  EXPECT_EQ(session.document().version(), 0u);
  step(R"({"do": "vessel_tree", "file": "below/tree.json)" + tree);
  step(R"({"do": "save"})");
  EXPECT_TRUE(fs::exists(place / "mine/below/tree.json"));
}

TEST_F(Writing, AnInstrumentOfOnesOwnIsFoundByTheNameThatItsFileGives) {
  write("mine/forceps.json", R"({"format": 1, "name": "my_forceps", "title": "Forceps", "kind": "grasper",
      "shaft_diameter_mm": 5, "shaft_length_mm": 310, "jaw_length_mm": 22})");
  begin("mine/scene.json");
  step(kBall);
  step(R"({"do": "hold", "of": "ball", "centre_mm": [0, -150, -110], "radius_mm": 9})");
  for (const char* tip : {"[30, -150, -80]", "[-30, -150, -80]"})
    step(std::string(R"({"do": "tool", "instrument": "forceps.json", "port": "left_lower", "tip_mm": )") + tip + "}");
  const Built built = build(session.document());
  EXPECT_TRUE(built.good()) << (built.faults.empty() ? "" : core::to_string(built.faults.front()));
  EXPECT_NE(fault_of(R"({"do": "tool", "instrument": "../forceps.json", "port": "left_lower", "tip_mm": [0, 0, 0]})")
                .find("expected a file in "),
            std::string::npos);
  EXPECT_NE(fault_of(R"({"do": "tool", "instrument": "none.json", "port": "left_lower", "tip_mm": [0, 0, 0]})")
                .find("none.json: expected a file, got none of this name"),
            std::string::npos);
}

}  // namespace
}  // namespace trocar::modeller
