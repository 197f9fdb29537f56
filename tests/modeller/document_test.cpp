// Documents: nothing is lost by opening, changing, undoing and saving, whatever happens meanwhile.
#include <algorithm>

#include <sys/stat.h>
#include <unistd.h>

#include <trocar/core/random.hpp>
#include <trocar/modeller/document/home.hpp>
#include <trocar/modeller/document/recovery.hpp>
#include <trocar/modeller/operations/points.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/json/json_edit.hpp>
#include <trocar/scene/json/json_text.hpp>

#include "../full_disk.hpp"
#include "workplace.hpp"

namespace trocar::modeller {
namespace {

/// Every scene that is shipped, copied with all that scenes name, so that it can be saved.
fs::path copied_scenes(const Workplace& place) {
  fs::copy("scenes", place / "scenes", fs::copy_options::recursive);
  return place / "scenes";
}

std::vector<fs::path> scene_files(const fs::path& scenes) {
  std::vector<fs::path> files;
  for (const scene::SceneEntry& s : scene::list_scenes(scenes)) files.push_back(s.path);
  files.push_back(scenes / "modelling" / "place.json");
  return files;
}

TEST(Document, AnUneditedSaveOfEveryShippedSceneChangesNoByte) {
  const Workplace place;
  for (const fs::path& file : scene_files(copied_scenes(place))) {
    Document document = Document::open(file);
    std::vector<std::string> before;
    for (const fs::path& f : document.files()) before.push_back(read(f));
    ASSERT_GT(before.size(), 1u) << file;
    document.save();
    const std::vector<fs::path> files = document.files();
    for (std::size_t i = 0; i < files.size(); ++i) EXPECT_EQ(read(files[i]), before[i]) << files[i];
  }
}

TEST(Document, EveryShippedSceneIsOutlinedAndReadAsItIs) {
  for (const fs::path& file : scene_files("scenes")) {
    const Document document = Document::open(file);
    std::vector<core::Fault> faults;
    ASSERT_TRUE(document.description(faults).has_value()) << file << core::to_string(faults.front());
    for (const Thing& thing : outline(document)) {
      const scene::JsonValue value = value_of(document, thing);
      ASSERT_NE(value.find("name"), nullptr) << thing.file << thing.path;
      EXPECT_EQ(value.find("name")->value.text, thing.name);
    }
  }
}

/// A random change of a random thing of the document: moved, or one of its points moved, put in, taken away.
void change_anything(Document& document, core::Random& random) {
  std::vector<Thing> things;
  for (Thing& t : outline(document))
    if (!point_lists(value_of(document, t)).empty()) things.push_back(std::move(t));
  if (things.empty()) return;
  const Thing& thing = things[std::size_t(random.uniform() * double(things.size()))];
  const std::string of = thing.kind + ":" + thing.name;
  const int what = int(random.uniform() * 4);
  const std::string by = "[" + std::to_string(random.uniform(-5, 5)) + ", 1, -2]";
  if (what == 0) return apply(document, "move", "{\"of\": [\"" + of + "\"], \"by_mm\": " + by + "}");
  if (what == 1) return apply(document, "move_point", "{\"of\": \"" + of + "\", \"item\": 0, \"by_mm\": " + by + "}");
  if (what == 2) {
    fault_of(document, "insert_point", "{\"of\": \"" + of + "\", \"before\": 1}");
    return;
  }
  fault_of(document, "rename",
           "{\"of\": \"" + of + "\", \"to\": \"other_" + std::to_string(random.next() % 1000) + "\"}");
}

TEST(Document, UndoingAllChangesGivesEveryByteBackAndRedoingThemTheSameAgain) {
  const Workplace place;
  core::Random random(11);
  for (const fs::path& file : scene_files(copied_scenes(place))) {
    Document document = Document::open(file);
    for (int i = 0; i < 8; ++i) change_anything(document, random);
    const std::size_t changes = document.done();
    const Texts changed = document.changed_texts();
    while (document.undo()) {
    }
    EXPECT_TRUE(document.unsaved().empty()) << file;
    for (std::size_t i = 0; i < changes; ++i) EXPECT_TRUE(document.redo());
    EXPECT_EQ(document.changed_texts(), changed) << file;
  }
}

TEST(Document, CommentsAreStillThereAfterEdits) {
  const Workplace place;
  const fs::path scenes = copied_scenes(place);
  Document document = Document::open(scenes / "gynaecology" / "scene.json");
  const Thing uterus = thing_named(document, "uterus");
  apply(document, "move", R"({"of": ["uterus", "tube_left"], "by_mm": [0, 0, 4]})");
  apply(document, "set", R"({"of": "uterus", "key": "cell_mm", "value": 3.6})");
  document.save();
  EXPECT_EQ(read(uterus.file).find("// Uterus, 75 x 49 x 34 mm"), 0u);
  EXPECT_NE(read(uterus.file).find("\"cell_mm\": 3.6"), std::string::npos);
}

TEST(Document, AFileThatSomebodyElseHasChangedIsNotOverwritten) {
  const Workplace place;
  const fs::path scenes = copied_scenes(place);
  Document document = Document::open(scenes / "cutting" / "scene.json");
  apply(document, "set", R"({"key": "title", "value": "mine"})");
  std::ofstream(scenes / "cutting" / "scene.json", std::ios::app) << "\n// theirs\n";
  EXPECT_THROW(document.save(), core::BadInput);
  EXPECT_NE(read(scenes / "cutting" / "scene.json").find("theirs"), std::string::npos);
  EXPECT_EQ(document.unsaved().size(), 1u);
  document.save(true);
  EXPECT_NE(read(scenes / "cutting" / "scene.json").find("mine"), std::string::npos);
}

TEST(Document, WhereTheFolderIsReadOnlyTheReasonIsToldAndNothingIsLost) {
  if (geteuid() == 0) {  // root may write anywhere: a folder that is a file cannot be written into by anybody
    const Workplace place;
    std::ofstream(place / "taken") << "a file";
    Document document = begun(place / "taken" / "scene.json", false, "lost");
    EXPECT_THROW(document.save(), core::BadInput);
    EXPECT_EQ(document.unsaved().size(), 1u);
    document.save_as(place / "elsewhere.json");
    EXPECT_TRUE(fs::exists(place / "elsewhere.json"));
    return;
  }
  const Workplace place;
  fs::create_directories(place / "shut");
  chmod((place / "shut").c_str(), 0500);
  Document document = begun(place / "shut" / "scene.json", false, "lost");
  EXPECT_THROW(document.save(), core::BadInput);
  chmod((place / "shut").c_str(), 0700);
  EXPECT_EQ(document.unsaved().size(), 1u);
  document.save();
  EXPECT_TRUE(document.unsaved().empty());
}

TEST(Document, WhereTheDiskIsFullThatIsToldAndNothingIsLost) {
  const Workplace place;
  const fs::path file = copied_scenes(place) / "cutting" / "scene.json";
  const std::string before = read(file);
  Document document = Document::open(file);
  Recovery recovery(place / "unsaved", document.root());
  apply(document, "set", R"({"key": "title", "value": "mine"})");
  std::string said, kept;
  {
    const test::FullDisk disk(100);
    try {
      document.save();
    } catch (const core::BadInput& bad) {
      said = bad.what();
    }
    kept = recovery.keep(document);
  }
  EXPECT_NE(said.find("nothing is lost: save again elsewhere or when that is mended"), std::string::npos) << said;
  EXPECT_EQ(read(file), before);
  EXPECT_FALSE(fs::exists(file.string() + ".part"));
  EXPECT_EQ(document.unsaved().size(), 1u);
  EXPECT_NE(kept, "");
  EXPECT_EQ(recovery.keep(document), "") << "tried again though nothing has changed since";
  EXPECT_EQ(lost_in(place / "unsaved").size(), 1u);
  document.save();
  EXPECT_NE(read(file).find("mine"), std::string::npos);
}

TEST(Document, SavedElsewhereItStillFindsWhatItNames) {
  const Workplace place;
  Document document = begun(place / "a" / "scene.json", false, "mine");
  apply(document, "ellipsoid",
        R"({"name": "ball", "tissue": "uterus", "centre_mm": [0, -150, -110], "half_mm": [10, 15, 10]})");
  document.save();
  document.save_as(place / "b" / "c" / "scene.json");
  const Document again = Document::open(place / "b" / "c" / "scene.json");
  std::vector<core::Fault> faults;
  const auto description = again.description(faults);
  ASSERT_TRUE(description.has_value()) << core::to_string(faults.front());
  EXPECT_EQ(description->solids.size(), 1u);
  EXPECT_FALSE(description->tissues.empty());
}

TEST(Recovery, WhatIsUnsavedIsThereAfterACrashAndGoneAfterASave) {
  const Workplace place;
  const fs::path scenes = copied_scenes(place), file = scenes / "cutting" / "scene.json";
  {
    Document document = Document::open(file);
    Recovery recovery(place / "unsaved", document.root());
    apply(document, "set", R"({"key": "title", "value": "not saved \u00e4"})");
    apply(document, "move", R"({"of": ["liver"], "by_mm": [1, 2, 3]})");
    EXPECT_EQ(recovery.keep(document), "");
  }  // a crash: nothing was saved
  const std::vector<Lost> lost = lost_in(place / "unsaved");
  ASSERT_EQ(lost.size(), 1u);
  Document again = recovered(lost[0]);
  EXPECT_EQ(again.unsaved().size(), 2u);
  EXPECT_NE(again.text(again.root()).find("not saved"), std::string::npos);
  Recovery recovery(place / "unsaved", again.root());
  again.save();
  EXPECT_EQ(recovery.keep(again), "");
  EXPECT_TRUE(lost_in(place / "unsaved").empty());
}

TEST(Recovery, DamagedFilesAreLeftAside) {
  const Workplace place;
  fs::create_directories(place / "unsaved");
  std::ofstream(place / "unsaved/half.json") << "{\"root\": \"/tmp/x.json\", \"texts\": [{\"fi";
  EXPECT_TRUE(lost_in(place / "unsaved").empty());
  EXPECT_TRUE(fs::exists(place / "unsaved/half.json"));
}

}  // namespace
}  // namespace trocar::modeller
