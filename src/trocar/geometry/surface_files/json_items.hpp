// JSON of a mesh file (glTF), read strictly, in which every value knows its byte. People's own files, with comments and
// all faults in one pass, are read by scene/json; here what a program wrote is either JSON or not.
//
//   const JsonItems json(in, text);                              // in tells faults, text is a part of its bytes
//   const int nodes = json.member(json.root(), "nodes");         // -1 where there is none
//   for (const int node : json.items(nodes)) ...
//
// Strings stay where they are until they are asked for, so that an embedded buffer of many megabytes costs nothing.
// [RFC 8259]. At most 64 levels and two million values.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <trocar/geometry/formats/mesh_source.hpp>

namespace trocar::geometry {

class JsonItems {
 public:
  enum class Kind : unsigned char { null, boolean, number, string, array, object };
  static constexpr int kMostLevels = 64;
  static constexpr std::size_t kMostValues = 2'000'000;

  /// @param text  a part of in.all(). Throws core::BadInput at the first byte that is not as it should be.
  JsonItems(MeshSource& in, std::string_view text);

  int root() const { return 0; }
  Kind kind(int item) const { return m_items[item].kind; }
  std::size_t place(int item) const { return m_items[item].at; }  ///< in the file

  /// Of an object the value of a key; -1 for none, and of what is no object.
  int member(int item, std::string_view key) const;
  /// Of an array or object, in order; nothing of other values and of -1.
  std::vector<int> items(int item) const;
  std::string_view key(int item) const { return m_items[item].key; }  ///< within an object, escapes as they stand

  double number(int item) const { return m_items[item].number; }
  std::string_view raw_text(int item) const { return m_items[item].text; }  ///< of a string, escapes as they stand
  std::string text(int item) const;                                         ///< UTF-8

  /// How a fault names a value: "a string", "12", "an array".
  std::string shown(int item) const;

 private:
  struct Item {
    Kind kind = Kind::null;
    std::size_t at = 0;
    double number = 0;
    std::string_view text, key;
    int first = -1, next = -1;  ///< of what it holds; of what holds it
  };
  MeshSource& m_in;
  std::string_view m_text;
  std::size_t m_offset;  ///< of the text in the file
  std::size_t m_at = 0;
  std::vector<Item> m_items;

  [[noreturn]] void lose(const char* expected) const;
  char next_char() const { return m_at < m_text.size() ? m_text[m_at] : '\0'; }
  void skip_space();
  bool take(char c);
  int value(int level);
  void members(int item, char end, int level);
  void number_into(Item& item);
  std::string_view string();
  void word_into(Item& item);
};

}  // namespace trocar::geometry
