// The key "marks" of scene files: discs, and stripes around strands.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/files/writer.hpp>
#include <trocar/sim/model/state.hpp>

#include "files.hpp"

namespace trocar::scene {
namespace {

/// A ball, a cord beside it and a floor under both; the marks are what is tested.
std::string scene_with(const std::string& marks) {
  return R"({"format": 1, "name": "small",
    "tissues": [{"name": "soft", "density_kg_m3": 1050, "young_Pa": 5000, "source": "ours"}],
    "organs": [{
      "solids": [{"name": "ball", "tissue": "soft", "cell_mm": 4, "anchors": [{"centre_mm": [0, 0, -60], "radius_mm": 9}],
        "sections": [{"centre_mm": [0, 0, -48], "across_mm": [10, 0, 0], "deep_mm": [0, 10, 0]},
                     {"centre_mm": [0, 0, -56], "across_mm": [10, 0, 0], "deep_mm": [0, 10, 0]}]}],
      "strands": [{"name": "cord", "tissue": "soft", "centreline_mm": [[20, 0, -50], [40, 0, -50], [60, 0, -50]],
        "stations": [{"s_mm": 0, "radius_mm": 2}], "start": {"fixed": true}, "end": {"fixed": true}}],
      "pouches": [{"name": "sac", "tissue": "soft", "thickness_mm": 1, "spacing_mm": 5,
        "held": [{"centre_mm": [-30, 0, -50], "radius_mm": 10}],
        "sections": [{"centre_mm": [-30, 0, -45], "across_mm": [8, 0, 0], "deep_mm": [0, 8, 0]},
                     {"centre_mm": [-30, 0, -55], "across_mm": [8, 0, 0], "deep_mm": [0, 8, 0]}]}],
      "walls": [{"name": "floor", "net_mm": [[[-80, 80, -70], [80, 80, -70]], [[-80, -80, -70], [80, -80, -70]]]}]}],
    )" + marks +
         R"(
    "instruments": [], "ports": [{"name": "navel", "position_mm": [0, 0, 0], "diameter_mm": 10}], "tools": [],
    "scope": {"port": "navel", "tip_mm": [0, 0, -20]}})";
}

std::vector<std::string> faults_of(const std::string& marks) {
  const Folder folder;
  std::vector<std::string> messages;
  try {
    compile(read_scene(folder.write("scene.json", scene_with("\"marks\": [" + marks + "],"))));
  } catch (const core::BadInput& bad) {
    for (const core::Fault& f : bad.faults()) messages.push_back(f.message);
  }
  return messages;
}
using Messages = std::vector<std::string>;

sim::Model with(const std::string& marks) {
  const Folder folder;
  return compile(read_scene(folder.write("scene.json", scene_with("\"marks\": [" + marks + "],"))));
}

TEST(Marks, LieInSpaceOnAWallOnAnOrganAndAroundAStrand) {
  const sim::Model model = with(R"(
    {"name": "free", "place_mm": [5, 6, -30], "normal": [0, 0.3, 0.4], "diameter_mm": 4, "label": "12", "colour": "blue"},
    {"name": "down", "on": "floor", "place_mm": [50, 50, -66]},
    {"name": "top", "on": "ball", "place_mm": [0, 0, -41]},
    {"name": "ring", "on": "cord", "at_mm": 15, "width_mm": 1.5})");
  ASSERT_EQ(model.marks.size(), 4u);
  const sim::State state = sim::initial_state(model);
  const auto pose = [&](size_t i) { return sim::pose_of(model, state, model.marks[i]); };
  EXPECT_NEAR(length(pose(0).place - Vec3d{0.005, 0.006, -0.030}), 0, 1e-9);
  EXPECT_NEAR(length(pose(0).normal - Vec3d{0, 0.6, 0.8}), 0, 1e-12);
  EXPECT_NEAR(model.marks[0].half, 0.002, 1e-12);
  EXPECT_EQ(model.marks[0].label, "12");
  EXPECT_NEAR(length(pose(1).place - Vec3d{0.050, 0.050, -0.070}), 0, 1e-6) << "the nearest place of the floor";
  EXPECT_NEAR(pose(1).normal.z, 1, 1e-6);
  EXPECT_NEAR(pose(2).place.z, -0.038, 0.001) << "on the ball's skin";
  EXPECT_GT(pose(2).normal.z, 0.9);
  EXPECT_NEAR(length(pose(3).place - Vec3d{0.035, 0, -0.050}), 0, 2e-4);
  EXPECT_NEAR(std::fabs(pose(3).normal.x), 1, 1e-3) << "a stripe's is the strand's direction";
  EXPECT_TRUE(model.marks[3].is_stripe());
  EXPECT_NEAR(model.marks[3].half, 0.00075, 1e-12);
  for (const char* name : {"free", "down", "top", "ring"}) EXPECT_GE(model.target_index(name), 0) << name;
}

TEST(Marks, GoAlongWithWhatTheyLieOn) {
  const sim::Model model = with(R"({"name": "top", "on": "ball", "place_mm": [0, 0, -41]},
                                   {"name": "ring", "on": "cord", "at_mm": 15})");
  sim::State state = sim::initial_state(model);
  const Vec3d before[2] = {pose_of(model, state, model.marks[0]).place, pose_of(model, state, model.marks[1]).place};
  for (tissue::NodeState& node : state.solids[0].nodes) node.x += 0.003f;
  for (Vec3d& x : state.strands[0].x) x.y += 0.002;
  EXPECT_NEAR(length(pose_of(model, state, model.marks[0]).place - before[0] - Vec3d{0.003, 0, 0}), 0, 1e-6);
  EXPECT_NEAR(length(pose_of(model, state, model.marks[1]).place - before[1] - Vec3d{0, 0.002, 0}), 0, 1e-9);
}

TEST(Marks, LieOnPouchesAndGoAlong) {
  const sim::Model model = with(R"({"name": "belly", "on": "sac", "place_mm": [-22, 0, -50]})");
  sim::State state = sim::initial_state(model);
  const sim::MarkPose before = pose_of(model, state, model.marks[0]);
  EXPECT_NEAR(before.place.x, -0.022, 0.001);
  EXPECT_GT(before.normal.x, 0.9) << "out of the pouch";
  for (tissue::NodeState& node : state.membranes[0].network.nodes) node.z += 0.004f;
  EXPECT_NEAR(length(pose_of(model, state, model.marks[0]).place - before.place - Vec3d{0, 0, 0.004}), 0, 1e-6);
  EXPECT_GE(model.target_index("sac"), 0) << "seen as a whole, too";
}

TEST(Marks, ChangeTheHashOfTheirSceneOnly) {
  const Folder folder;
  const sim::Model without = compile(read_scene(folder.write("a.json", scene_with("")))), empty = with(""),
                   some = with(R"({"name": "free", "place_mm": [5, 6, -30], "normal": [0, 0.3, 0.4]})"),
                   turned = with(R"({"name": "free", "place_mm": [5, 6, -30], "normal": [0, 0.4, 0.3]})");
  EXPECT_EQ(without.hash, empty.hash);
  EXPECT_NE(without.hash, some.hash);
  EXPECT_NE(some.hash, turned.hash);
}

TEST(Marks, AreWrittenAsTheyWereRead) {
  const Folder folder;
  const std::string marks =
      R"("marks": [{"name": "free", "place_mm": [5, 6.1, -30], "normal": [0, 0.3, 0.4], "label": "7"},
                               {"name": "ring", "on": "cord", "at_mm": 15.3, "colour": "black"}],)";
  const Description d = read_scene(folder.write("a.json", scene_with(marks)));
  const Description again = read_scene(folder.write("b.json", write_scene(d)));
  ASSERT_EQ(again.marks.size(), 2u);
  EXPECT_EQ(compile(again).hash, compile(d).hash);
  EXPECT_EQ(again.marks[0].label, "7");
  EXPECT_EQ(again.marks[1].colour, "black");
  EXPECT_TRUE(again.marks[1].stripe);
}

TEST(Marks, FaultsSayWhatIsMissing) {
  EXPECT_EQ(faults_of(R"({"name": "a", "place_mm": [0, 0, -30]})"),
            Messages{"expected the normal of a disc in space, got none"});
  EXPECT_EQ(faults_of(R"({"name": "a", "on": "ball"})"),
            Messages{"expected place_mm of a disc or at_mm of a stripe, got neither"});
  EXPECT_EQ(faults_of(R"({"name": "a", "on": "cord", "at_mm": 15, "label": "3"})"),
            Messages{"expected no normal of a stripe (at_mm), got one"});
  EXPECT_EQ(faults_of(R"({"name": "a", "on": "ball", "at_mm": 15})"),
            Messages{"expected a strand that the stripe goes around, got \"ball\""});
  EXPECT_EQ(faults_of(R"({"name": "a", "on": "cord", "place_mm": [30, 0, -50]})"),
            Messages{"expected at_mm of a stripe on the strand \"cord\", got a disc"});
  EXPECT_EQ(faults_of(R"({"name": "a", "on": "cord", "at_mm": 60})"),
            Messages{"expected an arc length on \"cord\" (at most 40.0 mm), got 60"});
  EXPECT_EQ(faults_of(R"({"name": "a", "on": "cordd", "at_mm": 15})").size(), 2u);
  EXPECT_EQ(faults_of(R"({"name": "a", "on": "floor", "place_mm": [0, 0, -30]})"),
            Messages{"expected a place within 10 mm of \"floor\", got one 40.0 mm away"});
  EXPECT_EQ(faults_of(R"({"name": "a", "place_mm": [0, 0, -30], "normal": [0, 0, 1], "label": "A"})"),
            Messages{"expected at most three digits, got \"A\""});
  EXPECT_EQ(faults_of(R"({"name": "ball", "place_mm": [0, 0, -30], "normal": [0, 0, 1]})").size(), 1u)
      << "marks and bodies are one family of names";
}

}  // namespace
}  // namespace trocar::scene
