// docs/reference/scene_format.md ends with the tables of keys; they are written from the reader's own tables.
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <trocar/scene/files/look_file.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/files/vessel_file.hpp>

#include "files.hpp"

namespace trocar::scene {
namespace {

std::string range_of(const Key& key) {
  return key.low == key.high ? fmt::format("{}", key.low) : fmt::format("{} to {}", key.low, key.high);
}

std::string anchor_of(const std::string& name) {
  std::string anchor;
  for (const char c : name) anchor += c == ' ' ? '-' : c;
  return fmt::format("[{}](#{})", name, anchor);
}

std::string values_of(const Key& key) {
  using Type = Key::Type;
  const std::string many = key.min_count > 0 ? fmt::format("at least {} ", key.min_count) : "";
  switch (key.type) {
    case Type::number:
      return "number, " + range_of(key);
    case Type::integer:
      return "whole number, " + range_of(key);
    case Type::flag:
      return "true or false";
    case Type::text: {
      std::string choices;
      for (const std::string& choice : key.choices) choices += (choices.empty() ? "" : ", ") + choice;
      return choices.empty() ? "text" : choices;
    }
    case Type::name:
      return "name";
    case Type::texts:
      return "array of texts";
    case Type::vec3:
      return "three numbers, " + range_of(key);
    case Type::points:
      return fmt::format("array of {}points, {}", many, range_of(key));
    case Type::lines:
      return fmt::format("array of lines of {}points, {}", many, range_of(key));
    case Type::grid:
      return fmt::format("array of {}rows of {}points, {}", many, many, range_of(key));
    case Type::numbers:
      return fmt::format("array of {}numbers, {}", many, range_of(key));
    case Type::table:
      return fmt::format("array of {}rows of numbers, {}", many, range_of(key));
    case Type::object:
      return anchor_of(key.shape().name);
    case Type::objects:
      return fmt::format("array of {}{}", many, anchor_of(key.shape().name));
    case Type::includes:
      return fmt::format("array of file names or {}", anchor_of(key.shape().name));
    case Type::any:
      return "see the meaning";
  }
  return "";
}

/// Lines of at most 118 bytes, broken at spaces.
std::string in_lines(const std::string& text) {
  std::string lines;
  std::size_t used = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    if (used > 0 && used + 1 + word.size() > 118) {
      lines += '\n';
      used = 0;
    }
    lines += (used > 0 ? " " : "") + word;
    used += (used > 0 ? 1 : 0) + word.size();
    at = end + 1;
  }
  return lines;
}

/// The tables of a shape and of all shapes it refers to, each once.
void add_tables(const Shape& shape, std::vector<std::string>& done, std::string& page) {
  for (const std::string& name : done)
    if (name == shape.name) return;
  done.push_back(shape.name);
  page += fmt::format("\n### {}\n\n{}\n\n|key|value|meaning|\n|-|-|-|\n", shape.name, in_lines(shape.meaning));
  for (const Key& key : shape.keys)
    page += fmt::format("|`{}`{}|{}|{}|\n", key.name, key.required ? " (needed)" : "", values_of(key), key.meaning);
  for (const Key& key : shape.keys)
    if (key.shape) add_tables(key.shape(), done, page);
}

TEST(FormatPage, TablesOfKeysAreTheReaders) {
  std::string tables;
  std::vector<std::string> done;
  for (const Shape* shape :
       {&scene_shape(), &organ_shape(), &instrument_shape(), &tissue_shape(), &vessels_shape(), &look_shape()})
    add_tables(*shape, done, tables);
  const std::string marker = "<!-- from here on written from the reader's tables -->\n";
  const std::string page = text_of(TROCAR_SOURCE_DIR "/docs/reference/scene_format.md");
  const std::size_t at = page.find(marker);
  const std::filesystem::path fresh = std::filesystem::path(TROCAR_BINARY_DIR) / "scene_format_tables.md";
  std::ofstream(fresh) << tables;
  ASSERT_NE(at, page.npos);
  EXPECT_EQ(page.substr(at + marker.size()), tables)
      << "docs/reference/scene_format.md: replace what follows the marker by " << fresh.generic_string();
}

}  // namespace
}  // namespace trocar::scene
