// JSON with comments, read into a tree in which every value and every key knows its line and column.
//
// This is the one reader of JSON that comes from outside: files that people write, and those of other programs (glTF).
// People write the files of scenes/ by hand, so a fault must say where it stands, and all faults of a file must come in
// one pass. Event interfaces of JSON libraries stop at the first bad number; this reader continues after every fault
// that leaves the structure readable (a number that is not finite, a bad word, a key given twice, a comma too many) and
// stops only where the structure itself is lost. Grammar: RFC 8259, and comments as in C++. Limits: 64 levels of
// nesting, half a million values, 256 keys in one object; a kind of file may have less (JsonLimits). What Trocar itself
// writes and reads back: core/json.hpp.
//
//   std::vector<Fault> faults;
//   const JsonDocument document = parse_json(text, "tissues.json", faults);
//   if (!faults.empty()) throw BadInput(std::move(faults));
//   for (const JsonMember& m : document.root.members) ...
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <trocar/core/error.hpp>

namespace trocar::core {

struct JsonMember;

struct JsonValue {
  /// `broken`: a fault has been reported about this value already; readers say no more about it.
  enum class Kind : unsigned char { null, boolean, number, string, array, object, broken };

  Kind kind = Kind::null;
  bool truth = false;
  int line = 0, column = 0;         ///< of the value's first character, 1-based; columns count characters, not bytes
  std::uint32_t from = 0, to = 0;   ///< the value's bytes in the text, [from, to): for who edits it (json_edit.hpp)
  double number = 0;                ///< always finite
  std::string text;                 ///< string: UTF-8, escapes resolved
  std::vector<JsonValue> items;     ///< array
  std::vector<JsonMember> members;  ///< object, in file order, keys all different

  const JsonMember* find(std::string_view key) const;  ///< null where the key is not there
};

struct JsonMember {
  std::string key;
  int line = 0, column = 0;  ///< of the key
  JsonValue value;
  std::uint32_t from = 0;  ///< of the key's first byte
};

struct JsonDocument {
  std::string file;  ///< as faults show it
  JsonValue root;    ///< broken where the text has no readable value
  int values = 0;    ///< read
};

inline constexpr int kMaxJsonDepth = 64;
inline constexpr int kMaxJsonValues = 500'000;
inline constexpr std::size_t kMaxJsonKeys = 256;  ///< in one object
inline constexpr std::size_t kMaxFaults = 1000;   ///< reported of one text

/// How much a text may hold: asked while it is read, so that what is refused takes neither time nor memory.
struct JsonLimits {
  int values = kMaxJsonValues;
  std::size_t text_bytes = std::string::npos;  ///< of one string
};

/// Appends a fault; where there are kMaxFaults already, only that not all are reported.
void tell(std::vector<Fault>& faults, Fault fault);

/// Reads `text`; what is wrong with it is appended to `faults`. Never throws on bad text.
JsonDocument parse_json(std::string_view text, std::string file, std::vector<Fault>& faults,
                        const JsonLimits& limits = {});

/// How a fault names a value: `"text"`, `-3`, `an array`, `null` (long strings are shortened).
std::string shown(const JsonValue& value);

}  // namespace trocar::core
