// The key "leaves" of scene files.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/files/writer.hpp>

#include "files.hpp"

namespace trocar::scene {
namespace {

/// A ball, fat beside it, and leaves.
std::string scene_with(const std::string& leaves) {
  return R"({"format": 1, "name": "small",
    "tissues": [{"name": "soft", "density_kg_m3": 1050, "young_Pa": 5000, "source": "ours"}],
    "organs": [{
      "solids": [{"name": "ball", "tissue": "soft", "cell_mm": 4, "anchors": [{"centre_mm": [0, 0, -60], "radius_mm": 9}],
        "sections": [{"centre_mm": [0, 0, -48], "across_mm": [10, 0, 0], "deep_mm": [0, 10, 0]},
                     {"centre_mm": [0, 0, -56], "across_mm": [10, 0, 0], "deep_mm": [0, 10, 0]}]}]}],
    "fat": [{"name": "pad", "fills": [{"line_mm": [[9, 0, -42]], "radius_mm": 5}], "on": ["ball"], "reach_mm": 5}],
    "leaves": [)" +
         leaves + R"(],
    "instruments": [], "ports": [{"name": "navel", "position_mm": [0, 0, 0], "diameter_mm": 10}], "tools": [],
    "scope": {"port": "navel", "tip_mm": [0, 0, -20]}})";
}

std::string leaf(const std::string& more, const std::string& tissue = "soft", double spacing = 4) {
  return R"({"name": "leaf", "tissue": ")" + tissue + R"(", "thickness_mm": 0.4, "spacing_mm": )" +
         fmt::format("{}", spacing) + R"(,
    "lines_mm": [[[-8, -8, -40], [8, -8, -40]], [[-8, 8, -40], [8, 8, -40]]])" +
         more + "}";
}
const char* const kBonds = R"(, "bonds": [{"name": "loose", "on": ["ball", "pad"], "reach_mm": 9,
    "places": [{"centre_mm": [0, 0, -40], "radius_mm": 30}]}])";

std::vector<std::string> faults_of(const std::string& leaves) {
  const Folder folder;
  std::vector<std::string> messages;
  try {
    compile(read_scene(folder.write("scene.json", scene_with(leaves))));
  } catch (const core::BadInput& bad) {
    for (const core::Fault& f : bad.faults()) messages.push_back(f.message);
  }
  return messages;
}
using Messages = std::vector<std::string>;

TEST(Leaves, AreSheetsTiedToOrgansAndFat) {
  const Folder folder;
  const Description d = read_scene(folder.write("a.json", scene_with(leaf(kBonds))));
  const sim::Model m = compile(d);
  ASSERT_EQ(m.membranes.size(), 1u);
  EXPECT_EQ(m.membranes[0].sheet.columns, 5);
  EXPECT_EQ(m.membranes[0].sheet.rows, 5);
  const interactions::BondSet& set = m.bonds[std::size_t(m.bonds_index("loose"))];
  int on_fat = 0, on_organ = 0;
  for (const interactions::Bond& bond : set.bonds)
    on_fat += bond.far.body.is(BodyKind::fat), on_organ += bond.far.body.is(BodyKind::organ);
  EXPECT_GT(on_organ, 5);
  EXPECT_GT(on_fat, 0);
  EXPECT_NEAR(set.area(), 16e-3 * 16e-3, 0.5 * 16e-3 * 16e-3);
  const Description again = read_scene(folder.write("b.json", write_scene(d)));
  EXPECT_EQ(compile(again).hash, m.hash);
}

TEST(Leaves, FaultsSayWhatIsWrong) {
  EXPECT_EQ(faults_of(leaf("")), Messages{});
  EXPECT_EQ(faults_of(leaf("", "silk")).size(), 1u);
  EXPECT_EQ(faults_of(leaf(R"(, "held": [{"centre_mm": [50, 0, -40], "radius_mm": 2}])")),
            Messages{"expected a place that holds at least one node of 'leaf', got none"});
  EXPECT_EQ(
      faults_of(leaf(R"(, "bonds": [{"name": "loose", "on": ["ball"], "reach_mm": 0.5,
              "places": [{"centre_mm": [0, 0, -40], "radius_mm": 30}]}])")),
      Messages{"expected a node of 'leaf' in the places of \"loose\" that is free and at most 0.5 mm from what it is "
               "tied to, got none"});
  EXPECT_EQ(faults_of(leaf("", "soft", 0.05)), Messages{"expected a number in [0.3, 50] for \"spacing_mm\", got 0.05"});
}

}  // namespace
}  // namespace trocar::scene
