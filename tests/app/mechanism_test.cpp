// `trocar mechanism`: poses and workspaces as scripts ask for them, and what it says of faults.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "run_program.hpp"

namespace trocar::app {
namespace {

double coordinate(const Json& pose, const std::string& name) {
  for (const Json& c : pose["coordinates"])
    if (c["name"] == name) return c["value"];
  return std::nan("");
}

TEST(Mechanism, AHandleHalfShutLeavesTheJawsPartlyOpen) {
  const Outcome o = trocar({"mechanism", "grasper", "pose", "--drive", "handle=0.5", "--json"});
  ASSERT_EQ(o.exit, 0) << o.err;
  const Json pose = o.json();
  EXPECT_EQ(pose["mobility"], 1);
  EXPECT_LT(pose["gap_mm"], 1e-9);
  EXPECT_GT(coordinate(pose, "jaw_upper"), 3);
  EXPECT_LT(coordinate(pose, "jaw_upper"), 27);
  EXPECT_NEAR(coordinate(pose, "jaw_upper"), coordinate(pose, "jaw_lower"), 1e-9);
}

TEST(Mechanism, ASetCoordinateIsThereAndOthersFollow) {
  const Outcome o = trocar({"mechanism", "four_bar", "--set", "crank=150", "--json"});
  ASSERT_EQ(o.exit, 0) << o.err;
  EXPECT_NEAR(coordinate(o.json(), "crank"), 150, 1e-9);
  EXPECT_TRUE(trocar({"mechanism", "four_bar", "--set", "crank=150"}).out.find("over-constrained but consistent") !=
              std::string::npos);
}

TEST(Mechanism, WhatCannotBeReachedIsTold) {
  const Outcome o = trocar({"mechanism", "four_bar", "--set", "rocker=20", "--json"});
  EXPECT_EQ(o.exit, 1);
  EXPECT_LT(o.json()["reached"], 1);
  EXPECT_NE(o.json()["words"].get<std::string>().find("singular"), std::string::npos);
}

TEST(Mechanism, AWorkspaceHasAVolumeOrAWay) {
  const Outcome arm = trocar({"mechanism", "dvrk_arm", "workspace", "--samples", "20000", "--json"});
  ASSERT_EQ(arm.exit, 0) << arm.err;
  EXPECT_GT(arm.json()["volume_mL"], 1000);
  EXPECT_LT(arm.json()["volume_mL"], 100'000);
  const Outcome linkage = trocar({"mechanism", "four_bar", "workspace", "--json"});
  ASSERT_EQ(linkage.exit, 0) << linkage.err;
  EXPECT_GT(linkage.json()["path_mm"], 10);
}

TEST(Mechanism, WrongWordsExitWithTwoAndSayWhatThereIs) {
  const Outcome name = trocar({"mechanism", "four_bar", "--set", "cranck=10"});
  EXPECT_EQ(name.exit, 2);
  EXPECT_NE(name.err.find("did you mean \"crank\"?"), std::string::npos) << name.err;
  EXPECT_EQ(trocar({"mechanism", "four_bar", "--set", "crank=nan"}).exit, 2);
  EXPECT_EQ(trocar({"mechanism", "four_bar", "--drive", "motor"}).exit, 2);
  EXPECT_EQ(trocar({"mechanism", "four_bar", "dance"}).exit, 2);
  EXPECT_EQ(trocar({"mechanism", "nowhere"}).exit, 2);
  EXPECT_EQ(trocar({"mechanism", "four_bar", "workspace", "--frame", "toe"}).exit, 2);
}

TEST(Mechanism, WithoutAFrameTheFirstOneIsMeasured) {
  const Outcome o =
      trocar({"mechanism", "colliding_grasper", "tolerance", "--plus-minus-um", "10", "--samples", "200"});
  EXPECT_EQ(o.exit, 0) << o.err;
  EXPECT_NE(o.out.find("tip_upper"), std::string::npos) << o.out;
}

TEST(Mechanism, AWrongNameIsAnsweredWithTheNearestOne) {
  EXPECT_NE(trocar({"mechanism", "four_bra"}).err.find("did you mean \"four_bar\"?"), std::string::npos);
  EXPECT_NE(trocar({"room", "telemanipulatet"}).err.find("did you mean \"telemanipulated\"?"), std::string::npos);
}

TEST(Mechanism, AToleranceStudySaysFirstOrderAndSamplesAndLeavesAPage) {
  const std::string folder = testing::TempDir() + "trocar_tolerance_page";
  const Outcome o =
      trocar({"mechanism", "grasper", "tolerance", "--frame", "tip_upper", "--drive", "handle=0.5", "--plus-minus-um",
              "10", "--within", "60", "--samples", "20000", "--report", folder, "--json"});
  ASSERT_EQ(o.exit, 0) << o.err;
  const Json study = o.json();
  EXPECT_NEAR(study["deviation"].get<double>() / study["linear"]["deviation"].get<double>(), 1, 0.02);
  EXPECT_GT(study["yield"], 0.5);
  EXPECT_LT(study["yield"], 0.8);
  EXPECT_EQ(study["open"], 0);
  std::ifstream page(study["page"].get<std::string>());
  const std::string html{std::istreambuf_iterator<char>(page), {}};
  EXPECT_NE(html.find("histogram"), std::string::npos);
  EXPECT_NE(html.find("slot_offset"), std::string::npos);
  EXPECT_NE(html.find("Yield: "), std::string::npos);
}

TEST(Mechanism, AnInternalCollisionIsToldAndOptimisedAway) {
  const Outcome before = trocar({"mechanism", "colliding_grasper", "clearance", "--json"});
  EXPECT_EQ(before.exit, 1);
  EXPECT_LT(before.json()["least_mm"], 0);
  EXPECT_EQ(before.json()["pairs"][0]["second"], "bar_upper");
  const std::string folder = testing::TempDir() + "trocar_optimise_page";
  const Outcome after =
      trocar({"mechanism", "colliding_grasper", "optimise", "--frame", "tip_upper", "--report", folder, "--json"});
  EXPECT_EQ(after.exit, 0) << after.err;
  EXPECT_EQ(after.json()["free"], true);
  EXPECT_GE(after.json()["after"]["least_mm"], 0.1);
  EXPECT_GE(after.json()["range_share"], 0.95);
  EXPECT_TRUE(std::ifstream(folder + "/index.html").good());
}

/// An instrument with 16 mm of jaws around a mechanism's file beside it.
std::string instrument_around(const std::filesystem::path& folder, const std::string& mechanism) {
  const std::filesystem::path file = folder / "mine.json";
  std::ofstream(file) << R"({"format": 1, "name": "mine", "title": "Mine", "kind": "grasper", "shaft_diameter_mm": 5,
 "shaft_length_mm": 310, "jaw_length_mm": 16, "jaw_width_mm": 4, "jaw_thickness_mm": 1.8, "mechanism": ")"
                      << mechanism << R"(", "pinch_max_N": 20, "friction": 1.67})";
  return file.string();
}

TEST(Mechanism, AnOptimisedGrasperClosesAndAnInstrumentTakesIt) {
  const std::filesystem::path folder = testing::TempDir() + "trocar_optimised";
  std::filesystem::create_directories(folder);
  const std::string optimised = (folder / "optimised.json").string();
  const Outcome o =
      trocar({"mechanism", "colliding_grasper", "optimise", "--clearance-um", "100", "--output", optimised});
  ASSERT_EQ(o.exit, 0) << o.out << o.err;
  EXPECT_NE(o.out.find("with handle at 1 it ends 0.0"), std::string::npos) << o.out;
  const Outcome closed = trocar({"mechanism", optimised, "pose", "--drive", "handle=1", "--json"});
  ASSERT_EQ(closed.exit, 0) << closed.err;
  EXPECT_NEAR(coordinate(closed.json(), "jaw_upper"), 0, 0.3);
  EXPECT_EQ(trocar({"mechanism", optimised, "clearance"}).exit, 0);
  EXPECT_EQ(trocar({"check", optimised}).exit, 0);
  EXPECT_EQ(trocar({"check", instrument_around(folder, "optimised.json")}).exit, 0);
}

TEST(Mechanism, AnInstrumentWhoseJawsDoNotMeetIsAFaultOfItsOwnFile) {
  const std::filesystem::path folder = testing::TempDir() + "trocar_open_jaws";
  std::filesystem::create_directories(folder);
  std::ifstream in(TROCAR_SOURCE_DIR "/scenes/mechanisms/colliding_grasper.json");
  std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string shut = "\"rod_shut\", \"length_mm\": 8.377";
  ASSERT_NE(text.find(shut), std::string::npos);
  text.replace(text.find(shut), shut.size(), "\"rod_shut\", \"length_mm\": 8.2");
  std::ofstream(folder / "open.json") << text;
  const Outcome o = trocar({"check", instrument_around(folder, "open.json")});
  EXPECT_EQ(o.exit, 2);
  EXPECT_NE(o.err.find("expected jaws that meet when the handle is closed"), std::string::npos) << o.err;
}

TEST(Mechanism, ARingThatIsReleasedSwingsAndKeepsItsEnergy) {
  const std::string table = testing::TempDir() + "trocar_motion.csv";
  const Outcome o = trocar({"mechanism", "bricard", "motion", "--seconds", "0.5", "--data", table, "--json"});
  ASSERT_EQ(o.exit, 0) << o.out << o.err;
  const Json motion = o.json();
  EXPECT_EQ(motion["steps"], 1000);
  EXPECT_GT(motion["most_kinetic_J"], 0);
  EXPECT_LT(motion["energy_off_J"], 1e-6);
  std::ifstream in(table);
  std::size_t lines = 0;
  for (std::string line; std::getline(in, line);) ++lines;
  EXPECT_EQ(lines, 1002u) << "a head, the start, and every step";
  EXPECT_EQ(trocar({"mechanism", "bricard", "motion", "--seconds", "100", "--step-ms", "0.01"}).exit, 2);
}

TEST(Mechanism, CheckWarnsOfAMimickedJointThatCannotFollow) {
  const std::string path = testing::TempDir() + "trocar_mimic.urdf";
  std::ofstream(path) << R"(<robot name="jaws"><link name="base"/><link name="l"/><link name="r"/>
<joint name="jaw_l" type="revolute"><parent link="base"/><child link="l"/><limit lower="0" upper="0.5"/></joint>
<joint name="jaw_r" type="revolute"><parent link="base"/><child link="r"/><limit lower="0" upper="0.5"/>
<mimic joint="jaw_l" multiplier="-1"/></joint></robot>)";
  const Outcome o = trocar({"check", path});
  EXPECT_EQ(o.exit, 0) << o.err;
  EXPECT_NE(o.out.find("mechanism, to mend"), std::string::npos) << o.out;
  EXPECT_NE(o.out.find("warning: "), std::string::npos) << o.out;
  EXPECT_NE(o.out.find("jaw_r follows jaw_l, which leads it from -28.65 to 0 degrees"), std::string::npos) << o.out;
}

TEST(Mechanism, CheckNamesXacroAndYamlWithTheRemedy) {
  const std::string xacro = testing::TempDir() + "arm.urdf.xacro", yaml = testing::TempDir() + "network.yml";
  std::ofstream(xacro) << "<robot name=\"arm\"><link name=\"base\"/></robot>";
  std::ofstream(yaml) << "project name: cca\nnetwork:\n  - label: cca\n";
  const Outcome o = trocar({"check", xacro, yaml});
  EXPECT_EQ(o.exit, 2);
  EXPECT_NE(o.err.find("Expand it: xacro "), std::string::npos) << o.err;
  EXPECT_NE(o.err.find("network.yml:1:1: expected JSON, got YAML"), std::string::npos) << o.err;
  EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 2) << o.err;
}

TEST(Mechanism, WrongWordsOfAStudyExitWithTwo) {
  EXPECT_EQ(trocar({"mechanism", "grasper", "tolerance", "--frame", "toe"}).exit, 2);
  EXPECT_EQ(trocar({"mechanism", "grasper", "tolerance", "--frame", "tip_upper", "--along", "1,2"}).exit, 2);
  EXPECT_EQ(trocar({"mechanism", "grasper", "tolerance", "--frame", "tip_upper", "--along", "0,0,0"}).exit, 2);
  EXPECT_EQ(trocar({"mechanism", "grasper", "tolerance", "--frame", "tip_upper", "--distance"}).exit, 2);
  EXPECT_EQ(trocar({"mechanism", "grasper", "tolerance", "--frame", "tip_upper", "--set", "rod=3"}).exit, 2);
  EXPECT_EQ(trocar({"mechanism", "grasper", "clearance", "--ignore", "jaw_upper"}).exit, 2);
  EXPECT_EQ(trocar({"mechanism", "grasper", "clearance", "--ignore", "jaw_upper:hand"}).exit, 2);
  EXPECT_EQ(trocar({"mechanism", "bricard", "tolerance", "--frame", "tip"}).exit, 2);
  const Outcome far =
      trocar({"mechanism", "grasper", "tolerance", "--frame", "tip_upper", "--drive", "handle=50", "--json"});
  EXPECT_EQ(far.exit, 1);
  EXPECT_EQ(far.json()["closed"], false);
}

TEST(Mechanism, CheckSaysWhatAFileHolds) {
  const Outcome o = trocar({"check", TROCAR_SOURCE_DIR "/scenes/mechanisms/bricard.json", "--json"});
  ASSERT_EQ(o.exit, 0) << o.err;
  EXPECT_EQ(o.json()["files"][0]["kind"], "mechanism");
  EXPECT_EQ(o.json()["files"][0]["mobility"], 1);
}

TEST(Mechanism, FaultsOfItsFileAreAllTold) {
  const std::string path = testing::TempDir() + "trocar_mechanism_test.json";
  std::ofstream(path)
      << "{\"format\": 1, \"name\": \"bad\",\n \"links\": [{\"name\": \"a\", \"joint\": {\"kind\": \"hinge\"}},\n"
         " {\"name\": \"b\", \"joint\": {\"kind\": \"revolute\"}, \"at_mm\": [1]}]}\n";
  const Outcome o = trocar({"mechanism", path, "--json"});
  EXPECT_EQ(o.exit, 2);
  EXPECT_EQ(o.json()["faults"].size(), 2u) << o.err;
  EXPECT_EQ(o.json()["faults"][0]["line"], 2);
}

}  // namespace
}  // namespace trocar::app
