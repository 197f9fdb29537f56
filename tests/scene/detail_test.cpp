// The key "detail" of scene files: how finely things are drawn.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/files/writer.hpp>

#include "files.hpp"

namespace trocar::scene {
namespace {

/// A scene with one organ; what is tested stands in line 7.
std::string scene_with(const std::string& detail) {
  return "{\n\"format\": 1, \"name\": \"small\",\n\"tissues\": [{\"name\": \"soft\", \"density_kg_m3\": 1050, "
         "\"young_Pa\": 5000, \"source\": \"ours\"}],\n\"organs\": [{\"solids\": [\n"
         "{\"name\": \"liver\", \"tissue\": \"soft\", \"cell_mm\": 6, \"sections\": [{\"centre_mm\": [0, 0, -100], "
         "\"across_mm\": [0, 10, 0], \"deep_mm\": [0, 0, 10]}, {\"centre_mm\": [40, 0, -100], \"across_mm\": [0, 10, "
         "0], \"deep_mm\": [0, 0, 10]}], \"anchors\": [{\"centre_mm\": [20, 0, -110], \"radius_mm\": 12}]}\n]}],\n" +
         detail +
         "\n\"instruments\": [{\"name\": \"stick\", \"kind\": \"probe\"}],\n\"ports\": [{\"name\": \"navel\", "
         "\"position_mm\": [0, 0, 0], \"diameter_mm\": 10}],\n\"tools\": [],\n\"scope\": {\"port\": \"navel\", "
         "\"tip_mm\": [0, 0, -40]}\n}\n";
}
constexpr int kLine = 7;

/// The faults' messages. An '@' in `detail` marks where the first one is expected.
std::vector<std::string> faults_of(std::string detail) {
  const std::size_t at = detail.find('@');
  if (at != detail.npos) detail.erase(at, 1);
  const Folder folder;
  std::vector<std::string> messages;
  try {
    read_scene(folder.write("scene.json", scene_with(detail)));
  } catch (const core::BadInput& bad) {
    for (const core::Fault& f : bad.faults()) {
      const bool marked = !messages.empty() || (f.at.line == kLine && f.at.column == int(at) + 1);
      messages.push_back(marked ? f.message
                                : fmt::format("away from @, at {}:{}: {}", f.at.line, f.at.column, f.message));
    }
  }
  return messages;
}
using Messages = std::vector<std::string>;

std::string levels(const std::string& list) {
  return "\"detail\": [{\"of\": [\"liver\"], \"levels\": [" + list + "]}],";
}

TEST(DetailInFiles, GoesToTheModelAndNotIntoItsHash) {
  const Folder folder;
  const sim::Model without = compile(read_scene(folder.write("a.json", scene_with(""))));
  const sim::Model with = compile(read_scene(folder.write(
      "b.json", scene_with("\"detail\": [{\"of\": [\"liver\", \"stick\", \"cavity\"], \"levels\": [{\"from_mm\": 50, "
                           "\"error_mm\": 0.2}, {\"from_mm\": 100, \"error_mm\": 0.5, \"surface\": 1}]}],"))));
  ASSERT_EQ(with.drawn_detail.size(), 3u);
  EXPECT_EQ(with.drawn_detail[1].name, "stick");
  ASSERT_EQ(with.drawn_detail[1].levels.size(), 2u);
  EXPECT_EQ(with.drawn_detail[1].levels[0].from, 0.05);
  EXPECT_EQ(with.drawn_detail[1].levels[0].surface, 2);
  EXPECT_EQ(with.drawn_detail[1].levels[1].error, 0.0005);
  EXPECT_EQ(with.drawn_detail[1].levels[1].surface, 1);
  EXPECT_EQ(with.hash, without.hash);
}

TEST(DetailInFiles, NoLevelsMeanInFull) {
  const Folder folder;
  const sim::Model model = compile(read_scene(folder.write("a.json", scene_with(levels("")))));
  ASSERT_EQ(model.drawn_detail.size(), 1u);
  EXPECT_TRUE(model.drawn_detail[0].levels.empty());
}

TEST(DetailInFiles, IsWrittenAsItWasRead) {
  const Folder folder;
  const Description d = read_scene(folder.write(
      "a.json", scene_with(levels("{\"from_mm\": 50, \"error_mm\": 0.2}, {\"from_mm\": 90, \"error_mm\": 0.2, "
                                  "\"surface\": 0}"))));
  const Description again = read_scene(folder.write("b.json", write_scene(d)));
  ASSERT_EQ(again.detail.size(), 1u);
  EXPECT_EQ(again.detail[0].of, d.detail[0].of);
  ASSERT_EQ(again.detail[0].levels.size(), 2u);
  EXPECT_EQ(again.detail[0].levels[1].from, d.detail[0].levels[1].from);
  EXPECT_EQ(again.detail[0].levels[1].surface, 0);
}

TEST(DetailInFiles, FaultsAreToldWhereTheyStand) {
  EXPECT_EQ(faults_of(levels("{\"from_mm\": @-5, \"error_mm\": 0.2}")),
            Messages{"expected a number in [1, 2000] for \"from_mm\", got -5"});
  EXPECT_EQ(faults_of(levels("{\"from_mm\": 50, \"error_mm\": 0.2}, {\"from_mm\": @40, \"error_mm\": 0.3}")),
            Messages{"expected more than the level before, 50 mm, got 40"});
  EXPECT_EQ(faults_of(levels("{\"from_mm\": 50, \"error_mm\": 0.2}, {\"from_mm\": 60, \"error_mm\": @0.1}")),
            Messages{"expected no less than the level before, 0.2 mm, got 0.1"});
  EXPECT_EQ(faults_of(levels("{\"from_mm\": 50, \"error_mm\": 0.2, \"surface\": 1}, {\"from_mm\": 60, \"error_mm\": "
                             "0.2, \"surface\": @2}")),
            Messages{"expected no more than the level before, 1, got 2"});
  EXPECT_EQ(faults_of("\"detail\": [{\"of\": [\"liver\", @\"liver\"], \"levels\": []}],"),
            Messages{"expected everything once, got \"liver\" again"});
  EXPECT_EQ(faults_of("\"detail\": [{\"of\": @[], \"levels\": []}],"),
            Messages{"expected the name of something, got none"});
  const Messages unknown = faults_of("\"detail\": [{\"of\": [@\"livre\"], \"levels\": []}],");
  ASSERT_EQ(unknown.size(), 1u);
  EXPECT_NE(unknown[0].find("got \"livre\" (did you mean \"liver\"?)"), std::string::npos) << unknown[0];
}

TEST(DetailInFiles, MoreLevelsThanAnybodySeesAreAFault) {
  std::string many;
  for (int i = 1; i <= 9; ++i) many += fmt::format("{}{{\"from_mm\": {}, \"error_mm\": 1}}", i > 1 ? ", " : "", 10 * i);
  const Messages faults = faults_of(levels(many));
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_NE(faults[0].find("expected at most 8 levels, got 9"), std::string::npos) << faults[0];
}

}  // namespace
}  // namespace trocar::scene
