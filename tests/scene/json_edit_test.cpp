// Texts are edited without losing what their authors wrote: every shipped file is changed in many places, and read
// again.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include <trocar/core/files.hpp>
#include <trocar/core/random.hpp>
#include <trocar/scene/json/json_edit.hpp>
#include <trocar/scene/json/json_text.hpp>

namespace trocar::scene {
namespace {

namespace fs = std::filesystem;

JsonValue root_of(const std::string& text) {
  std::vector<core::Fault> faults;
  JsonDocument d = parse_json(text, "text", faults);
  EXPECT_TRUE(faults.empty()) << core::to_string(faults.front()) << "\n" << text;
  return std::move(d.root);
}

constexpr const char* kText = R"({
  // what it is
  "name": "ball",
  "size_mm": [1, 2.50, 3],  // as measured
  "parts": [
    {"a": 1},  // the first
    // before the second
    {"a": 2}
  ],
  "inner": {"x": 1e-3, "empty": []}
}
)";

std::string without(std::string text, const std::string& what) { return text.erase(text.find(what), what.size()); }

TEST(JsonEdit, AValueIsReplacedAndAllElseStaysByteForByte) {
  std::string expected = kText;
  expected.replace(expected.find("2.50"), 4, "7");
  EXPECT_EQ(json_set(kText, "/size_mm/1", json_number(7)), expected);
}

TEST(JsonEdit, TheSameValueLeavesTheTextAsItIs) {
  EXPECT_EQ(json_set(kText, "/size_mm/1", json_number(2.5)), kText);
  EXPECT_EQ(json_set(kText, "/inner/x", json_number(0.001)), kText);
}

TEST(JsonEdit, AKeyMoreGoesBehindTheLastOneOnItsOwnLine) {
  std::string expected = kText;
  expected.replace(expected.find("[]}\n}"), 5, "[]},\n  \"more\": true\n}");
  EXPECT_EQ(json_set(kText, "/more", json_flag(true)), expected);
}

TEST(JsonEdit, AnItemMoreGoesWhereItIsWantedAndCommentsStayWithTheirItems) {
  JsonValue item = json_object();
  put(item, "a", json_number(9));
  const std::string last = json_insert(kText, "/parts", 2, item);
  EXPECT_NE(last.find("{\"a\": 2},\n    {\"a\": 9}\n  ]"), last.npos) << last;
  const std::string first = json_insert(kText, "/parts", 0, item);
  EXPECT_NE(first.find("[\n    {\"a\": 9},\n    {\"a\": 1},  // the first"), first.npos) << first;
}

TEST(JsonEdit, WhatIsRemovedTakesItsCommaAndItsCommentAlong) {
  EXPECT_EQ(json_remove(kText, "/parts/0"), without(kText, "    {\"a\": 1},  // the first\n"));
  EXPECT_EQ(json_remove(kText, "/size_mm"), without(kText, "  \"size_mm\": [1, 2.50, 3],  // as measured\n"));
  EXPECT_EQ(json_remove(kText, "/inner"), without(kText, ",\n  \"inner\": {\"x\": 1e-3, \"empty\": []}"));
  const std::string one = json_remove(kText, "/parts/1");
  EXPECT_NE(one.find("{\"a\": 1}  // the first\n"), one.npos) << one;
}

TEST(JsonEdit, ABracketNeverEndsUpBehindACommentThatGoesToTheEndOfItsLine) {
  EXPECT_EQ(json_remove("{\n  // why\n  \"a\": 1\n}", "/a"), "{\n  // why\n}");
  EXPECT_EQ(json_remove("{\"a\": 1, // one\n \"b\": 2}", "/b"), "{\"a\": 1 // one\n}");
  EXPECT_EQ(json_remove("[1, /* two */ 2]", "/1"), "[1 /* two */]");
}

TEST(JsonEdit, AnEmptyArrayIsFilledAndEmptiedAgain) {
  const std::string filled = json_set(kText, "/inner/empty/0", json_number(4));
  EXPECT_NE(filled.find("\"empty\": [4]"), filled.npos) << filled;
  EXPECT_EQ(json_remove(filled, "/inner/empty/0"), kText);
}

TEST(JsonEdit, WhereNothingCanStandIsRefused) {
  EXPECT_THROW(json_set(kText, "/name/x", json_number(1)), std::invalid_argument);
  EXPECT_THROW(json_set(kText, "/parts/5", json_number(1)), std::invalid_argument);
  EXPECT_THROW(json_remove(kText, "/nothing"), std::invalid_argument);
  EXPECT_THROW(json_remove(kText, ""), std::invalid_argument);
  EXPECT_THROW(json_set("{\"a\": ", "/a", json_number(1)), std::invalid_argument);
}

std::vector<fs::path> shipped_files() {
  std::vector<fs::path> files;
  for (const fs::directory_entry& e : fs::recursive_directory_iterator("scenes"))
    if (e.path().extension() == ".json" && e.path().string().find("schema/") == std::string::npos)
      files.push_back(e.path());
  std::sort(files.begin(), files.end());
  return files;
}

void paths_under(const JsonValue& v, const std::string& path, std::vector<std::string>& out) {
  out.push_back(path);
  for (const JsonMember& m : v.members) paths_under(m.value, json_path(path, m.key), out);
  for (std::size_t i = 0; i < v.items.size(); ++i) paths_under(v.items[i], json_path(path, i), out);
}

std::vector<std::string> comments_of(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (const std::size_t at = line.find("  // "); at != line.npos || line.rfind("//", 0) == 0)
      out.push_back(line.substr(at == line.npos ? 0 : at));
  return out;
}

TEST(JsonEdit, InEveryShippedFileAnyValueCanBeSetInsertedAndRemoved) {
  core::Random random(7);
  for (const fs::path& file : shipped_files()) {
    const std::string text = core::read_file(file, kMaxJsonBytes);
    const JsonValue root = root_of(text);
    std::vector<std::string> paths;
    paths_under(root, "", paths);
    for (int round = 0; round < 12; ++round) {
      const std::string& path = paths[std::size_t(random.uniform() * double(paths.size()))];
      const JsonValue& there = *json_at(root, path);
      ASSERT_EQ(json_set(text, path, there), text) << file << path;
      if (there.kind == JsonValue::Kind::number) {
        const std::string changed = json_set(text, path, json_number(there.number + 1.25));
        ASSERT_EQ(comments_of(changed), comments_of(text)) << file << path;
        ASSERT_TRUE(same_json(root_of(json_set(changed, path, there)), root)) << file << path;
      }
      if (there.kind == JsonValue::Kind::array) {
        const std::size_t at = std::size_t(random.uniform() * double(there.items.size() + 1));
        const std::string more = json_insert(text, path, at, json_number(42));
        ASSERT_EQ(comments_of(more), comments_of(text)) << file << path << at;
        ASSERT_TRUE(same_json(root_of(json_remove(more, json_path(path, at))), root)) << file << path << "/" << at;
      }
      if (there.kind == JsonValue::Kind::object) {
        const std::string more = json_set(text, json_path(path, "ne/w~"), json_text("x"));
        ASSERT_EQ(comments_of(more), comments_of(text)) << file << path;
        ASSERT_TRUE(same_json(root_of(json_remove(more, json_path(path, "ne/w~"))), root)) << file << path;
      }
      if (!path.empty()) {
        const std::string less = json_remove(text, path);
        root_of(less);
      }
    }
  }
}

}  // namespace
}  // namespace trocar::scene
