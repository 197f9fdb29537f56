// `trocar room`: how a room stands, motions that can and cannot be done, ports, and what it says of faults.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "run_program.hpp"

namespace trocar::app {
namespace {

TEST(Room, StandsClearWithShaftsInTheirPorts) {
  const Outcome o = trocar({"room", "telemanipulated", "pose", "--json"});
  ASSERT_EQ(o.exit, 0) << o.err;
  const Json pose = o.json();
  ASSERT_EQ(pose["arms"].size(), 2u);
  for (const Json& a : pose["arms"]) EXPECT_LT(a["beside_port_mm"], 1e-6);
  for (const Json& p : pose["staff"]) EXPECT_EQ(p["beyond_reach_mm"], 0);
  EXPECT_GE(pose["clearance"][0]["mm"], 5);
}

TEST(Room, ATiltThatTheTableCannotIsNotWellDone) {
  EXPECT_EQ(trocar({"room", "telemanipulated", "pose", "--head-down", "20"}).exit, 0);
  const Outcome o = trocar({"room", "telemanipulated", "pose", "--head-down", "45", "--json"});
  EXPECT_EQ(o.exit, 1);
  EXPECT_EQ(o.json()["table"]["can"], false);
}

TEST(Room, AProgrammeThatCanBeDoneEndsWithZeroAndOneThatCannotWithOneAndWhen) {
  const Outcome good = trocar({"room", "telemanipulated", "programme", "triangle", "--json"});
  EXPECT_EQ(good.exit, 0) << good.err;
  EXPECT_LE(good.json()["port_gap_mm"], 0.1);
  EXPECT_LE(good.json()["loop_gap_m"], 1e-10);
  const Outcome bad = trocar({"room", "telemanipulated", "programme", "too_far", "--json"});
  EXPECT_EQ(bad.exit, 1);
  const Json faults = bad.json()["faults"];
  ASSERT_FALSE(faults.empty());
  EXPECT_EQ(faults[0]["kind"], "collision");
  EXPECT_EQ(faults[0]["with"], "patient");
  EXPECT_GT(faults[0]["from_s"], 2);
  EXPECT_LT(faults[0]["from_s"], 6);
}

TEST(Room, APlanHasSetsThatReachAndKnowsOrgansOfItsScene) {
  const Outcome o = trocar({"room", "telemanipulated", "plan", "--sets", "3", "--json"});
  ASSERT_EQ(o.exit, 0) << o.err;
  ASSERT_EQ(o.json()["sets"].size(), 3u);
  EXPECT_NEAR(o.json()["sets"][0]["manipulation_deg"], 60, 15);
  const Outcome wrong = trocar({"room", "telemanipulated", "plan", "--target", "gallblader"});
  EXPECT_EQ(wrong.exit, 2);
  EXPECT_NE(wrong.err.find("did you mean \"gallbladder\"?"), std::string::npos) << wrong.err;
}

TEST(Room, CheckSaysHowARoomStandsAndWhetherAProgrammeCanBeDone) {
  const std::string rooms = TROCAR_SOURCE_DIR "/scenes/rooms/";
  const Outcome good = trocar({"check", rooms + "telemanipulated.json", rooms + "programmes/triangle.json", "--json"});
  ASSERT_EQ(good.exit, 0) << good.err;
  EXPECT_EQ(good.json()["files"][0]["kind"], "room");
  EXPECT_EQ(good.json()["files"][0]["arms"], 2);
  EXPECT_EQ(good.json()["files"][1]["kind"], "programme");
  EXPECT_EQ(good.json()["files"][1]["room"], "telemanipulated");
  const Outcome bad = trocar({"check", rooms + "programmes/too_far.json", "--json"});
  EXPECT_EQ(bad.exit, 1);
  EXPECT_EQ(bad.json()["files"][0]["verdict"], "it cannot be done");
  EXPECT_FALSE(bad.json()["files"][0]["wrong"].empty());
}

TEST(Room, CheckTellsAllFaultsOfARoomInOnePass) {
  const std::filesystem::path folder = std::filesystem::path(TROCAR_BINARY_DIR) / "test-files" / "room-check";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "bad.json") << R"({"format": 1, "name": "bad", "arms": [{"name": "a", "mechanism": "none.json",
 "port": "nowhere", "on": "ceiling", "base": [1, 0, 0], "stand_mm": [0, 0]}], "margin_mm": -1})";
  const Outcome o = trocar({"check", (folder / "bad.json").string()});
  EXPECT_EQ(o.exit, 2);
  for (const char* told : {"none.json", "ceiling", "margin_mm"})
    EXPECT_NE(o.err.find(told), std::string::npos) << told << "\n" << o.err;
}

TEST(Room, WrongWordsExitWithTwo) {
  EXPECT_EQ(trocar({"room", "nowhere", "pose"}).exit, 2);
  EXPECT_EQ(trocar({"room", "telemanipulated", "dance"}).exit, 2);
  EXPECT_EQ(trocar({"room", "telemanipulated", "programme"}).exit, 2);
  EXPECT_EQ(trocar({"room", "telemanipulated", "programme", "nowhere"}).exit, 2);
  EXPECT_EQ(trocar({"room", "telemanipulated", "follow", "nowhere.rec"}).exit, 2);
  EXPECT_EQ(trocar({"room", "telemanipulated", "plan", "--grid-mm", "1"}).exit, 2);
}

TEST(Room, AReportHasItsPageAndPicturesOfTheWorstMoments) {
  const std::filesystem::path folder = std::filesystem::path(TROCAR_BINARY_DIR) / "test-files" / "room-report";
  std::filesystem::remove_all(folder);
  const Outcome o = trocar({"room", "telemanipulated", "programme", "too_far", "--out", folder.string(), "--size",
                            "320x200", "--step-ms", "50"});
  EXPECT_EQ(o.exit, 1) << o.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "index.html"));
  EXPECT_TRUE(std::filesystem::exists(folder / "moment-03.png"));
}

}  // namespace
}  // namespace trocar::app
