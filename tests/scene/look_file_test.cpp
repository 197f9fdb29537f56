// Looks are files: their figures arrive, what they inherit is what they do not say, a look that is not there is a
// fault.
#include <algorithm>

#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/look_file.hpp>
#include <trocar/scene/files/reader.hpp>

#include "files.hpp"

namespace trocar::scene {
namespace {

const std::filesystem::path kLooks = TROCAR_SOURCE_DIR "/scenes/looks";

const sim::Look* named(const MaterialFolders& materials, const std::string& name) {
  const auto& looks = materials.library()->looks;
  const auto it = std::find_if(looks.begin(), looks.end(), [&](const sim::Look& l) { return l.name == name; });
  return it == looks.end() ? nullptr : &*it;
}

struct Shelf {
  std::vector<core::Fault> faults;
  MemoryFiles files;
  MaterialFolders materials;
  explicit Shelf(MemoryFiles texts) : files(std::move(texts)), materials({"looks"}, faults, &files) {}
};

TEST(LookFile, EveryShippedLookIsSound) {
  std::vector<core::Fault> faults;
  const MaterialFolders materials({kLooks}, faults);
  EXPECT_EQ(told(faults), std::vector<std::string>{});
  EXPECT_GE(materials.names().size(), 30u);
}

TEST(LookFile, FiguresArriveInMetresAndAsTheyStand) {
  const Shelf s(MemoryFiles{{"looks/pale.json", R"({"format": 1, "colour": [250, 240, 230], "film_size_mm": 2.5,
    "relief": {"broad_mm": 1.5}, "surroundings": [{"generator": "fat_tags", "count": 7}]})"}});
  ASSERT_EQ(told(s.faults), std::vector<std::string>{});
  const sim::Look& pale = *named(s.materials, "pale");
  EXPECT_EQ(pale.colour, (Vec3d{250, 240, 230}));
  EXPECT_EQ(pale.film_size, 0.0025);
  EXPECT_EQ(pale.relief.broad, 0.0015);
  ASSERT_EQ(pale.surroundings.size(), 1u);
  EXPECT_EQ(pale.surroundings[0].generator, sim::Surrounding::Generator::fat_tags);
  EXPECT_EQ(pale.surroundings[0].count, 7);
  EXPECT_EQ(pale.wetness, sim::Look{}.wetness) << "what is not said is as usual";
}

TEST(LookFile, WhatALookDoesNotSayItInheritsWholeChainsOfThem) {
  const Shelf s(MemoryFiles{
      {"looks/a.json", R"({"format": 1, "colour": [1, 2, 3], "bump": 0.5, "relief": {"fine_mm": 1},
                                     "surroundings": [{"generator": "drape"}]})"},
      {"looks/b.json", R"({"format": 1, "inherits": "a", "bump": 0.25})"},
      {"looks/c.json", R"({"format": 1, "inherits": "b", "relief": {"broad_mm": 2}, "surroundings": []})"}});
  ASSERT_EQ(told(s.faults), std::vector<std::string>{});
  const sim::Look &b = *named(s.materials, "b"), &c = *named(s.materials, "c");
  EXPECT_EQ(b.name, "b");
  EXPECT_EQ(b.surroundings.size(), 1u);
  EXPECT_EQ(c.colour, (Vec3d{1, 2, 3}));
  EXPECT_EQ(c.bump, 0.25);
  EXPECT_EQ(c.relief.fine, 0.001);
  EXPECT_EQ(c.relief.broad, 0.002);
  EXPECT_TRUE(c.surroundings.empty());
}

TEST(LookFile, FaultsHavePlacesAndComeAllInOnePass) {
  const Shelf s(
      MemoryFiles{{"looks/a.json",
                   "{\"format\": 1, \"colour\": [1, 2, 300],\n \"wetnes\": 1,\n \"inherits\": \"bb\",\n"
                   " \"surroundings\": [{\"generator\": \"drap\"}, {\"generator\": \"drape\", \"count\": 2}]}"},
                  {"looks/b.json", R"({"format": 1})"}});
  EXPECT_EQ(
      told(s.faults),
      (std::vector<std::string>{
          "1:32 expected a number in [0, 255] for \"colour\", got 300",
          "2:2 expected a known key of a look, got \"wetnes\" (did you mean \"wetness\"?); known: " +
              [] {
                std::string keys;
                for (std::size_t i = 0; i < 12; ++i) keys += (i == 0 ? "" : ", ") + look_shape().keys[i].name;
                return keys + " and " + std::to_string(look_shape().keys.size() - 12) + " more";
              }(),
          "3:14 expected a known look, got \"bb\" (did you mean \"b\"?); known: a, b",
          "4:33 expected one of fat_tags, adhesions, curtains, drape, omentum, liver_dome, bowel_loops, porta for "
          "\"generator\", got \"drap\" (did you mean \"drape\"?)",
          "4:74 expected a count of what is counted only, got one of drape"}));
}

TEST(LookFile, LooksThatInheritEachOtherInACircleAreAFault) {
  const Shelf s(
      {{"looks/a.json", R"({"format": 1, "inherits": "b"})"}, {"looks/b.json", R"({"format": 1, "inherits": "a"})"}});
  EXPECT_EQ(
      told(s.faults),
      (std::vector<std::string>{"1:27 expected materials that do not inherit each other in a cycle, got a -> b -> a"}));
}

/// The cutting scene with another text for its liver's look.
std::vector<std::string> faults_with(const std::string& look, const Folder& folder) {
  std::string organ = text_of(TROCAR_SOURCE_DIR "/scenes/organs/liver_edge.json");
  const std::string said = "\"look\": \"liver\"";
  organ.replace(organ.find(said), said.size(), look);
  return told(check_file(folder.write("liver_edge.json", organ)));
}

TEST(LookFile, AnUnknownLookIsAFaultWithASuggestionInAnOrganToo) {
  const Folder folder;
  const std::vector<std::string> faults = faults_with("\"look\": \"livr\"", folder);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_NE(faults[0].find("expected a known look, "), std::string::npos) << faults[0];
  EXPECT_NE(faults[0].find("got \"livr\" (did you mean \"liver\"?)"), std::string::npos) << faults[0];
  EXPECT_EQ(faults_with("\"look\": \"bladder\"", folder), std::vector<std::string>{});
}

TEST(LookFile, ASceneTakesItsOwnTreesLookBeforeTheProgramsOfThatName) {
  const Folder folder;
  folder.write("looks/liver.json", R"({"format": 1, "colour": [0, 200, 0]})");
  std::string scene = text_of(TROCAR_SOURCE_DIR "/scenes/cutting/scene.json");
  for (const char* file : {"tissues.json", "organs/liver_edge.json", "organs/upper_abdomen.json",
                           "instruments/grasper.json", "instruments/scissors.json"}) {
    folder.write(file, text_of(std::string(TROCAR_SOURCE_DIR "/scenes/") + file));
    const std::string said = std::string("../") + file;
    scene.replace(scene.find(said), said.size(), file);
  }
  const Description d = read_scene(folder.write("scene.json", scene));
  const auto& looks = d.looks->looks;
  const auto colour = [&](const std::string& name) {
    return std::find_if(looks.begin(), looks.end(), [&](const sim::Look& l) { return l.name == name; })->colour;
  };
  EXPECT_EQ(colour("liver"), (Vec3d{0, 200, 0}));
  EXPECT_EQ(colour("steel"), (Vec3d{146, 148, 151})) << "the program's";
}

TEST(LookFile, ThePhysicsKnowsNothingOfLooks) {
  Description d = read_scene(TROCAR_SOURCE_DIR "/scenes/cutting/scene.json");
  const sim::Model with = compile(d);
  EXPECT_EQ(with.looks, d.looks);
  d.looks = nullptr;
  EXPECT_EQ(compile(d).hash, with.hash);
}

}  // namespace
}  // namespace trocar::scene
