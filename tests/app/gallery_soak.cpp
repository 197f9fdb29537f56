// Every picture of every scene: the gallery's instruments press, pull, cut and burn wherever a scene's organs happen to
// lie; and the names that --only is checked against are those of the pictures.
#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>

#include <gtest/gtest.h>
#include <unistd.h>

#include <trocar/attempt/paths.hpp>
#include <trocar/core/json.hpp>
#include <trocar/scene/files/reader.hpp>

#include "commands/gallery/gallery_names.hpp"
#include "commands/program.hpp"

namespace trocar::app {
namespace {

namespace fs = std::filesystem;

/// As files are called.
std::string plain(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '-';
  return name;
}

/// Of one scene's folder: "007-exchanged.png" is "exchanged".
std::set<std::string> drawn_in(const fs::path& folder) {
  std::ifstream in(folder / "index.json");
  const Json index = Json::parse(in);
  std::set<std::string> names;
  for (const Json& picture : index["pictures"]) {
    const auto file = picture["file"].get<std::string>();
    names.insert(file.substr(4, file.size() - 8));
  }
  return names;
}

TEST(Gallery, DrawsEverySceneUnderTheNamesThatItKnows) {
  const fs::path folder = fs::temp_directory_path() / ("trocar_gallery_" + std::to_string(getpid()));
  const std::string where = folder.string();
  const char* words[] = {"trocar", "gallery", where.c_str(), "--size", "160x120"};
  ASSERT_EQ(run_program(5, words), 0);
  std::set<std::string> drawn, known;
  for (const scene::SceneEntry& s : scene::list_scenes(attempt::scenes_folder())) {
    std::set<std::string> here;
    for (const std::string& name : gallery_names(scene::read_scene(s.path))) here.insert(plain(name));
    for (const std::string& name : drawn_in(folder / s.name)) {
      EXPECT_TRUE(here.count(name)) << s.name << ": " << name << " is drawn, --only does not know it";
      drawn.insert(name);
    }
    known.insert(here.begin(), here.end());
  }
  for (const std::string& name : known) EXPECT_TRUE(drawn.count(name)) << name << " is never drawn";
  fs::remove_all(folder);
}

}  // namespace
}  // namespace trocar::app
