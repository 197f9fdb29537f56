#include <functional>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <trocar/scene/files/look_file.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/files/vessel_file.hpp>
#include <trocar/scene/json/schema.hpp>
#include <trocar/scene/mechanisms/mechanism_file.hpp>
#include <trocar/scene/operating_room/room_file.hpp>
#include <trocar/training/exercise/exercise.hpp>

#include "files.hpp"

namespace trocar::scene {
namespace {

using nlohmann::json;

struct Published {
  const char* file;
  const Shape& (*shape)();
};
const Published kPublished[] = {{"scene.schema.json", scene_shape},
                                {"organ.schema.json", organ_shape},
                                {"instrument.schema.json", instrument_shape},
                                {"tissue.schema.json", tissue_shape},
                                {"vessel.schema.json", vessels_shape},
                                {"look.schema.json", look_shape},
                                {"mechanism.schema.json", mechanism_shape},
                                {"room.schema.json", room_shape},
                                {"programme.schema.json", programme_shape},
                                {"exercise.schema.json", training::exercise_shape},
                                {"common_rules.schema.json", training::common_rules_shape}};

TEST(Schema, PublishedFilesSayWhatTheReaderObeys) {
  for (const Published& p : kPublished) {
    const std::string published = text_of(std::string(TROCAR_SOURCE_DIR "/scenes/schema/") + p.file);
    const std::filesystem::path fresh = std::filesystem::path(TROCAR_BINARY_DIR) / "schema" / p.file;
    std::filesystem::create_directories(fresh.parent_path());
    std::ofstream(fresh) << json_schema(p.shape());
    EXPECT_EQ(published, json_schema(p.shape()))
        << "scenes/schema/" << p.file << " is out of date: copy " << fresh.generic_string();
  }
}

TEST(Schema, IsValidJsonWhoseReferencesAllResolve) {
  for (const Published& p : kPublished) {
    const json schema = json::parse(json_schema(p.shape()));
    const std::function<void(const json&)> check = [&](const json& node) {
      if (node.is_object() && node.contains("$ref")) {
        std::string pointer;
        const std::string reference = node["$ref"];
        for (std::size_t at = 1; at < reference.size(); ++at) {
          const bool space = reference.compare(at, 3, "%20") == 0;
          pointer.push_back(space ? ' ' : reference[at]);
          at += space ? 2 : 0;
        }
        EXPECT_TRUE(schema.contains(json::json_pointer(pointer))) << pointer;
      }
      if (!node.is_structured()) return;  // iterating over a number would give the number
      for (const json& child : node) check(child);
    };
    check(schema);
  }
}

// The two are one table; this holds the schema against the keys that the shipped files really use.
TEST(Schema, EveryKeyOfTheShippedFilesIsInTheSchema) {
  const json schema = json::parse(json_schema(organ_shape()));
  std::set<std::string> known;
  const std::function<void(const json&)> collect = [&](const json& node) {
    if (node.is_object() && node.contains("properties"))
      for (const auto& item : node["properties"].items()) known.insert(item.key());
    if (!node.is_structured()) return;  // iterating over a number would give the number
    for (const json& child : node) collect(child);
  };
  collect(schema);
  for (const auto& entry : std::filesystem::directory_iterator(TROCAR_SOURCE_DIR "/scenes/organs")) {
    const json file = json::parse(text_of(entry.path()), nullptr, true, true);
    const std::function<void(const json&)> check = [&](const json& node) {
      if (node.is_object()) {
        for (const auto& item : node.items()) EXPECT_TRUE(known.count(item.key())) << entry.path() << " " << item.key();
      }
      if (!node.is_structured()) return;  // iterating over a number would give the number
      for (const json& child : node) check(child);
    };
    check(file);
  }
}

}  // namespace
}  // namespace trocar::scene
