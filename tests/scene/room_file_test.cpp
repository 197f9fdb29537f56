#include <algorithm>

#include <gtest/gtest.h>

#include <trocar/scene/operating_room/room_file.hpp>

#include "files.hpp"

namespace trocar::scene {
namespace {

const char* const kSmallRoom = R"({"format": 1, "name": "small",
 "patient": {"stature_mm": 1650},
 "table": {"head_down_deg": 10, "left_down_deg": -5},
 "ports": [{"name": "a", "at_mm": [0, 0, 0], "diameter_mm": 10}, {"name": "b", "at_mm": [80, 0, -10]}],
 "staff": [{"name": "someone", "role": "camera_holder", "at_mm": [500, -100]}],
 "instruments": [{"name": "scope", "port": "a", "held_by": "someone", "tip_mm": [0, 60, -80], "camera": true}],
 "arms": [{"name": "left", "mechanism": "m.json", "port": "b", "on": "floor", "base": [1, 0, 1], "stand_mm": [600, 0]}]})";

std::vector<std::string> faults_of_room(const std::string& text) {
  std::vector<core::Fault> faults;
  parse_room(text, "r.json", faults);
  return told(faults);
}
std::string with(std::string text, const std::string& what, const std::string& instead) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, text.npos) << what;
  return text.replace(at, what.size(), instead);
}
bool one_has(const std::vector<std::string>& faults, const std::string& part) {
  return std::any_of(faults.begin(), faults.end(), [&](const std::string& f) { return f.find(part) != f.npos; });
}

TEST(RoomFile, IsReadInMetresAndRadians) {
  std::vector<core::Fault> faults;
  const Room r = parse_room(kSmallRoom, "r.json", faults);
  ASSERT_TRUE(faults.empty()) << told(faults)[0];
  EXPECT_DOUBLE_EQ(r.patient.stature, 1.65);
  EXPECT_NEAR(r.table.tilt.head_down, 0.17453, 1e-5);
  EXPECT_NEAR(r.table.tilt.left_down, -0.08727, 1e-5);
  EXPECT_EQ(r.ports[1].position, (Vec3d{0.08, 0, -0.01}));
  EXPECT_EQ(r.staff[0].role, StaffRole::camera_holder);
  EXPECT_TRUE(r.instruments[0].camera);
  EXPECT_FALSE(r.arms[0].on_table);
  EXPECT_NEAR(r.arms[0].fastest_turn, 2, 1e-12);
}

TEST(RoomFile, TellsEveryFaultInOnePassWithItsPlace) {
  std::string text = with(kSmallRoom, "\"port\": \"b\"", "\"port\": \"c\"");
  text = with(text, "\"held_by\": \"someone\"", "\"held_by\": \"somebody\"");
  text = with(text, "\"head_down_deg\": 10", "\"head_down_deg\": 50");
  text = with(text, "\"stature_mm\": 1650", "\"stature_mm\": 16500");
  text = with(text, "\"name\": \"b\"", "\"name\": \"a\"");
  const std::vector<std::string> faults = faults_of_room(text);
  EXPECT_EQ(faults.size(), 5u);
  EXPECT_TRUE(one_has(faults, "2:28 expected")) << faults[0];
  EXPECT_TRUE(one_has(faults, "expected an angle in the table's range, -30 to 30, got 50"));
  EXPECT_TRUE(one_has(faults, "expected a name that no other port has, got \"a\" again"));
  EXPECT_TRUE(one_has(faults, "got \"somebody\""));
  EXPECT_TRUE(one_has(faults, "got \"c\""));
}

TEST(RoomFile, ATipOutOfItsInstrumentsReachIsRefused) {
  EXPECT_TRUE(
      one_has(faults_of_room(with(kSmallRoom, "[0, 60, -80]", "[0, 60, -480]")), "expected a tip 1 mm to 290 mm"));
}

TEST(RoomFile, AMechanismThatLacksTheFramesOfAnArmIsToldAtTheArm) {
  const Folder folder;
  folder.write("m.json", R"({"format": 1, "name": "m", "links": [{"name": "l", "joint": {"kind": "revolute"}}],
    "frames": [{"name": "shaft", "link": "l"}]})");
  const auto path = folder.write("room.json", kSmallRoom);
  try {
    read_room(path);
    FAIL();
  } catch (const core::BadInput& bad) {
    ASSERT_EQ(bad.faults().size(), 1u);
    EXPECT_NE(bad.faults()[0].message.find("frame of the mechanism"), std::string::npos);
    EXPECT_EQ(bad.faults()[0].at.line, 7);
  }
}

TEST(RoomFile, OpensNothingOutOfItsTree) {
  const Folder folder;
  const auto path = folder.write("room.json", with(kSmallRoom, "m.json", "../../../../etc/passwd"));
  EXPECT_THROW(read_room(path), core::BadInput);
}

TEST(RoomFile, TheShippedRoomHasThePortsOfItsScene) {
  const Room r = read_room(TROCAR_SOURCE_DIR "/scenes/rooms/telemanipulated.json");
  EXPECT_EQ(r.ports.size(), 4u);
  EXPECT_GE(r.port("midclavicular"), 0);
  EXPECT_EQ(r.arms.size(), 2u);
  EXPECT_FALSE(r.arms[0].mechanism.closures.empty()) << "a closed loop keeps the remote centre";
}

TEST(ProgrammeFile, WantsTimeToGoOnAndArmsThatAreThere) {
  std::vector<core::Fault> faults;
  const Room room = parse_room(kSmallRoom, "r.json", faults);
  parse_programme(R"({"format": 1, "name": "p", "moves": [
    {"arm": "left", "poses": [{"at_s": 1, "tip_mm": [0, 0, -50]}, {"at_s": 1, "tip_mm": [0, 0, -60]}]},
    {"arm": "right", "poses": [{"at_s": 0, "tip_mm": [0, 0, -50], "roll_deg": 5}]}]})",
                  "p.json", &room, faults);
  const std::vector<std::string> all = told(faults);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0], "2:76 expected more than 1, the time before, got 1");
  EXPECT_TRUE(one_has(all, "expected a known arm, got \"right\"; known: left"));
  EXPECT_TRUE(one_has(all, "expected \"aims\": true beside it"));
}

}  // namespace
}  // namespace trocar::scene
