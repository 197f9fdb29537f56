// Bags, pebbles and bile in the pool as scenes have them, and what is refused with its place.
#include <string>

#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/description/vary.hpp>
#include <trocar/scene/files/reader.hpp>

#include "files.hpp"

using namespace trocar;
using namespace trocar::scene;

namespace {

/// What reading a scene says that is like the shipped one but for this line, its fifth.
std::string refusal(const std::string& line) {
  const Folder folder;
  const auto path = folder.write("scene.json", "{\n\"format\": 1, \"name\": \"other\",\n\"like\": \"" TROCAR_SOURCE_DIR
                                               "/scenes/cholecystectomy_spill/scene.json\",\n\n" +
                                                   line + "\n}\n");
  try {
    read_scene(path);
  } catch (const core::BadInput& e) {
    return e.what();
  }
  return "nothing was refused";
}
bool tells(const std::string& message, const char* what) { return message.find(what) != std::string::npos; }

Description spill() { return read_scene(TROCAR_SOURCE_DIR "/scenes/cholecystectomy_spill/scene.json"); }

}  // namespace

TEST(BagFile, TheShippedSceneHasABagFiveStonesAndBile) {
  const sim::Model m = compile(spill());
  const auto& bags = interactions::part_of<interactions::Bag>(m).list;
  ASSERT_EQ(bags.size(), 1u);
  EXPECT_EQ(bags[0].rigids, 5);
  EXPECT_EQ(bags[0].pouches.size(), 1u) << "the gallbladder";
  EXPECT_NEAR(double(m.wet.pool_at_start.bile) * 1e-9, 25, 1e-6);
  EXPECT_EQ(m.wet.pool_at_start.blood, 0);
}

TEST(BagFile, ABagOf60MillimetresIsAboutAsLargeAsItsMakersSay) {
  const sim::Model m = compile(spill());
  const interactions::BagModel& bag = interactions::part_of<interactions::Bag>(m).list[0];
  double volume = 0;  // of what its surface and the mouth's disc enclose [m^3]
  for (const auto& t : bag.triangles)
    volume += dot(bag.drawn[size_t(t[0])], cross(bag.drawn[size_t(t[1])], bag.drawn[size_t(t[2])])) / 6;
  EXPECT_NEAR(volume * 1e6, 200, 25);
}

TEST(BagFile, ASeedMovesWhereStonesFallWithTheAnatomy) {
  Description d = spill();
  const Vec3d before = settings_of(RigidScene{}, d.objects)[0].place;
  vary(d, 3);
  EXPECT_GT(length(settings_of(RigidScene{}, d.objects)[0].place - before), 1e-4);
  EXPECT_NO_THROW(compile(d));
}

TEST(BagFile, ABagThatNoHandCanBringInIsRefused) {
  Description d = spill();
  for (Port& p : d.ports) p.diameter = std::min(p.diameter, 0.005);
  d.placements[1].instrument = "grasper";
  try {
    compile(d);
    FAIL() << "nothing was refused";
  } catch (const core::BadInput& e) {
    EXPECT_NE(std::string(e.what()).find("expected an instrument of the kind \"bag\""), std::string::npos) << e.what();
  }
}

TEST(BagFile, WhatIsWrongIsToldWithItsPlace) {
  const std::string shallow = refusal(R"("bags": [{"name": "bag", "mouth_mm": 60, "deep_mm": 30}])");
  EXPECT_TRUE(tells(shallow, "scene.json:5:")) << shallow;
  EXPECT_TRUE(tells(shallow, "at least 0.75 times mouth_mm")) << shallow;
  const std::string two = refusal(R"("bags": [{"name": "one"}, {"name": "two"}])");
  EXPECT_TRUE(tells(two, "scene.json:5:")) << two;
  const std::string wide = refusal(R"("bags": [{"name": "bag", "mouth_mm": 1e6}])");
  EXPECT_TRUE(tells(wide, "[20, 120]")) << wide;
  const std::string both =
      refusal(R"("rigids": [{"name": "s", "pebble_mm": [5, 4, 3], "outer_mm": 9, "mass_g": 1, "at_mm": [0, 0, 0]}])");
  EXPECT_TRUE(tells(both, "several")) << both;
  const std::string thick =
      refusal(R"("rigids": [{"name": "s", "pebble_mm": [5, 4, 3], "thick_mm": 2, "mass_g": 1, "at_mm": [0, 0, 0]}])");
  EXPECT_TRUE(tells(thick, "it for a pebble")) << thick;
  const std::string order =
      refusal(R"("rigids": [{"name": "s", "pebble_mm": [3, 4, 5], "mass_g": 1, "at_mm": [0, 0, 0]}])");
  EXPECT_TRUE(tells(order, "the widest diameter first")) << order;
  const std::string none = refusal(R"("rigids": [{"name": "s", "mass_g": 1, "at_mm": [0, 0, 0]}])");
  EXPECT_TRUE(tells(none, "none of them")) << none;
  EXPECT_TRUE(tells(refusal(R"("fluids": {"pool_middle_mm": [0, 0, 0], "pool_bile_mL": -1})"), "pool_bile_mL"));
}
