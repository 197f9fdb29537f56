// Tables that say which keys a file's objects have, and checked access to objects by such a table.
//
// A Shape is one table: it drives the reader (types, ranges, unknown and missing keys, "did you mean"), and the
// published JSON Schema is written from it (schema.hpp), so the two cannot drift apart. A reader makes a JsonObject of
// a value and a Shape; what is wrong is appended to the faults at once, and access continues with fallbacks, so that
// one pass reports everything.
//
//   const Shape& ring() {
//     static const Shape shape{"ring", "A ring on a peg.", {
//         needed(keys::number("diameter_mm", 1, 50, "outer diameter")),
//         keys::choice("colour", {"red", "blue"}, "default red")}};
//     return shape;
//   }
//   JsonObject o(value, ring(), document.file, faults);
//   const double d = o.number("diameter_mm") / 1000;     // 0 where the file says nothing valid
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/numerics/vec3.hpp>
#include <trocar/scene/json/json.hpp>

namespace trocar::scene {

struct Shape;

/// One row of a table.
struct Key {
  enum class Type {
    number,    ///< in [low, high]
    integer,   ///< whole number in [low, high]
    flag,      ///< true or false
    text,      ///< any string; one of `choices` where there are some
    name,      ///< letters, digits, _ and -, not empty, at most 64
    texts,     ///< array of strings
    vec3,      ///< three numbers, each in [low, high]
    points,    ///< array of vec3
    lines,     ///< array of lines, each an array of at least `min_count` vec3
    grid,      ///< array of rows, each an array of vec3, all of the same length
    numbers,   ///< array of numbers in [low, high]
    table,     ///< array of rows, each an array of numbers in [low, high], all of the same length
    object,    ///< an object of `shape`
    objects,   ///< array of objects of `shape`
    includes,  ///< array of relative file names or objects of `shape`
    any,       ///< whatever its reader makes of it
  };
  std::string name;
  Type type = Type::text;
  std::string meaning;  ///< one line for people: what it is, the default
  double low = 0, high = 0;
  std::vector<std::string> choices;
  std::function<const Shape&()> shape;  ///< a function, so that tables may refer to each other
  std::size_t min_count = 0, max_count = 1000;
  bool required = false;
};

struct Shape {
  std::string name;     ///< "solid": faults say "a solid"
  std::string meaning;  ///< one or two sentences for people
  std::vector<Key> keys;

  const Key* find(std::string_view key) const;
};

/// Rows of a table. `low` and `high` belong to the range.
namespace keys {
Key number(std::string name, double low, double high, std::string meaning);
Key integer(std::string name, int low, int high, std::string meaning);
Key flag(std::string name, std::string meaning);
Key text(std::string name, std::string meaning);
Key name(std::string name, std::string meaning);
Key texts(std::string name, std::string meaning);
Key choice(std::string name, std::vector<std::string> choices, std::string meaning);
Key vec3(std::string name, double low, double high, std::string meaning);
Key points(std::string name, double low, double high, std::size_t min_count, std::string meaning);
Key lines(std::string name, double low, double high, std::size_t min_count, std::string meaning);
Key grid(std::string name, double low, double high, std::size_t min_count, std::string meaning);
Key numbers(std::string name, double low, double high, std::size_t min_count, std::string meaning);
Key table(std::string name, double low, double high, std::size_t min_count, std::string meaning);
Key object(std::string name, std::function<const Shape&()> shape, std::string meaning);
Key objects(std::string name, std::function<const Shape&()> shape, std::size_t min_count, std::string meaning);
Key includes(std::string name, std::function<const Shape&()> shape, std::string meaning);
Key any(std::string name, std::string meaning);
Key format(int version);  ///< "format": the version of the file's keys
}  // namespace keys
Key needed(Key key);                        ///< the same row, required
Key at_most(std::size_t count, Key items);  ///< the same row of a list, of so many items

/// Net of points, row by row.
struct PointGrid {
  std::size_t rows = 0, columns = 0;
  std::vector<Vec3d> points;
};

/// Rows of numbers, one after the other.
struct NumberTable {
  std::size_t rows = 0, columns = 0;
  std::vector<double> values;
};

/// An object of a file seen through its table. Cheap to copy; the value, table, file and faults must outlive it.
class JsonObject {
 public:
  /// Checks every key of `value` against `shape` (nested objects are checked when they are asked for).
  JsonObject(const JsonValue& value, const Shape& shape, const std::string& file, std::vector<core::Fault>& faults);

  /// Is the key there with a value of the right type, in range? Everything below gives the fallback where it is not.
  bool has(std::string_view key) const;
  /// Is it there at all, right or wrong?
  bool names(std::string_view key) const;
  double number(std::string_view key, double fallback = 0) const;
  int integer(std::string_view key, int fallback = 0) const;
  bool flag(std::string_view key, bool fallback = false) const;
  std::string text(std::string_view key, const std::string& fallback = {}) const;  ///< text, name, choice
  std::vector<std::string> texts(std::string_view key) const;
  Vec3d vec3(std::string_view key, Vec3d fallback = {}) const;
  std::vector<Vec3d> points(std::string_view key) const;
  std::vector<std::vector<Vec3d>> lines(std::string_view key) const;
  PointGrid grid(std::string_view key) const;
  std::vector<double> numbers(std::string_view key) const;
  NumberTable table(std::string_view key) const;

  /// The objects of an `objects` key, or the one of an `object` key: checked by the row's table. Of a list that is
  /// longer than its row allows, which is a fault, the first so many. Values of an `includes` key that are file names
  /// are left out; see values().
  std::vector<JsonObject> objects(std::string_view key) const;
  /// The raw values of an array key (empty where it is not there or broken).
  const std::vector<JsonValue>& values(std::string_view key) const;

  const JsonValue& value() const { return *m_value; }               ///< as it stands in the file
  core::Location at() const;                                        ///< where the object begins
  core::Location at(std::string_view key) const;                    ///< where the key's value begins, else at()
  core::Location at(std::string_view key, std::size_t item) const;  ///< where an array's item begins
  void fault(core::Location where, std::string message) const;      ///< `message` reads "expected ..., got ..."
  void fault(std::string_view key, std::string message) const;      ///< at the key's value

 private:
  const JsonValue* m_value;
  const Shape* m_shape;
  const std::string* m_file;
  std::vector<core::Fault>* m_faults;
  std::vector<char> m_good;  ///< per key of the table: there and well-formed

  void check_keys();
  void check_unknown(const JsonMember& member);
  const JsonValue* good(std::string_view key) const;
};

/// The candidate nearest to `word`, empty where none is near; "camra-0" is near "basics/camera-0", too.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// `word` was expected to be one of `known`: "expected a known tissue (liver, uterus), got "utreus" (did you mean
/// "uterus"?)".
/// @param what  what such a name is called, without an article
std::string unknown_name(std::string_view what, std::string_view word, const std::vector<std::string>& known);

}  // namespace trocar::scene
