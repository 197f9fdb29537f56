// `trocar mechanism`: poses and workspaces as scripts ask for them, and what it says of faults.
#include <cmath>
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
