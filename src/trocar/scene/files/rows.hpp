// One row a key. A row binds what a key of a file is (name, unit, range, meaning) to the member that holds it; the rows
// of a kind of object are a Table, and the reader, the writer, the published schema (json/schema.hpp) and the tables of
// docs/reference/scene_format.md follow from it. A key more is a row more.
//
//   const Table<Anchor>& anchor() {
//     using R = Rows<Anchor>;
//     static const Table<Anchor> table{"anchor", "The nodes within a ball are held.", {
//         needed(R::vec3("centre_mm", units::mm, &Anchor::centre, -2000, 2000, "centre of the ball")),
//         R::number("stiffness_N_m", units::one, &Anchor::stiffness, 0, 1e6, "of all springs, default {}: rigid")}};
//     return table;
//   }
//   anchor().read(object, a, context);         // faults go where the object's go
//   JsonValue o = anchor().written(a);
//
// A default stands in the member's initialiser and nowhere else: {} in a meaning becomes its value in the file's unit,
// what a file does not name keeps it, and what has it is not written. Where a value needs code of its own (a mesh, an
// include, a net of points), the row has its own functions; what must hold between keys is the table's check. A member
// is a pointer to one, or a function that finds it in the object: [](auto& d) -> auto& { return d.scope.angle; }.
// Private to the folder.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <trocar/scene/json/json_text.hpp>
#include <trocar/scene/json/shape.hpp>

namespace trocar::scene {

/// What a file says and what the program computes with.
struct Unit {
  double (*read)(double in_file);
  double (*guess)(double value);  ///< about the number that a file needs
};
namespace units {
extern const Unit one;
extern const Unit mm;                  ///< m. Divided, so that "1.5" becomes the number nearest to 0.0015
extern const Unit diameter;            ///< mm; the member is a radius [m]
extern const Unit deg;                 ///< rad
extern const Unit kilo;                ///< kPa of Pa
extern const Unit millilitre, litre;   ///< m^3
extern const Unit mmhg;                ///< Pa
extern const Unit mmhg_s_ml, ml_mmhg;  ///< of a resistance [Pa s/m^3], of a compliance [m^3/Pa]
}  // namespace units

/// The shortest decimal that reads back as exactly `value`; where there is none (reading may skip a double), the
/// nearest one.
double in_file(const Unit& unit, double value);

Vec3d read_by(const Unit& unit, Vec3d in_file);
JsonValue written_by(const Unit& unit, Vec3d value);
std::string shown_by(const Unit& unit, Vec3d value);  ///< "(0, 0, -9.81)"

/// An array of what `write` makes of each.
template <class List, class Write>
JsonValue listed(const List& things, Write&& write) {
  std::vector<JsonValue> items;
  for (const auto& thing : things) items.push_back(write(thing));
  return json_array(std::move(items));
}

/// Words of files, and what they mean.
template <class E>
using Choices = std::vector<std::pair<const char*, E>>;

/// A name that must belong to something by the time all files are read.
struct Reference {
  enum class To {
    tissue,
    solid,
    strand,
    solid_or_strand,
    carrier,
    tied,  ///< what bonds tie to
    vessel,
    port,
    instrument,
    drawn,
    look,
    marked,
    pouch
  };
  To to;
  std::string name;
  core::Location at;
};

class Reading;
/// What rows need beside the object that they read.
struct Context {
  std::filesystem::path folder;        ///< of the file: names in it are relative to this
  Reading* reading;                    ///< null where a file is read alone
  std::vector<Reference>& references;  ///< met so far
};

template <class T>
struct Row {
  Key key;
  std::function<void(const JsonObject&, T&, Context&)> read = nullptr;  ///< null: the table's check reads it
  /// None: not written. `needed`: also where it is the default.
  std::function<std::optional<JsonValue>(const T&, bool needed)> write = nullptr;

  /// The same row; where the value stands in the file is kept, too.
  template <class Member>
  Row placed(Member at) && {
    read = [inner = std::move(read), at, name = key.name](const JsonObject& o, T& t, Context& c) {
      inner(o, t, c);
      std::invoke(at, t) = o.at(name);
    };
    return std::move(*this);
  }
  /// The same row; written only for such objects, and then always.
  Row only(std::function<bool(const T&)> when) && {
    write = [inner = std::move(write), when = std::move(when)](const T& t, bool) {
      return when(t) ? inner(t, true) : std::nullopt;
    };
    return std::move(*this);
  }
};

template <class T>
Row<T> needed(Row<T> row) {
  row.key.required = true;
  return row;
}

/// The rows of a kind of object.
template <class T>
struct Table : Shape {
  using Check = void (*)(const JsonObject& o, T& t, Context& c);

  Table(std::string its_name, std::string its_meaning, std::vector<Row<T>> its_rows, Check its_check = nullptr)
      : Shape{std::move(its_name), std::move(its_meaning), {}}, rows(std::move(its_rows)), check(its_check) {
    for (const Row<T>& row : rows) keys.push_back(row.key);
  }

  void read(const JsonObject& o, T& t, Context& c) const {
    if constexpr (requires { t.at = o.at(); }) t.at = o.at();
    for (const Row<T>& row : rows)
      if (row.read) row.read(o, t, c);
    if (check) check(o, t, c);
  }
  T made(const JsonObject& o, Context& c) const {
    T t;
    read(o, t, c);
    return t;
  }
  JsonValue written(const T& t) const {
    JsonValue o = json_object();
    for (const Row<T>& row : rows)
      if (row.write)
        if (std::optional<JsonValue> value = row.write(t, row.key.required)) put(o, row.key.name, std::move(*value));
    return o;
  }

  std::vector<Row<T>> rows;
  Check check;  ///< after the rows: what must hold between keys, and defaults that follow from others
};

/// The rows of a file: those of its object, after "$schema" and "format".
template <class T>
std::vector<Row<T>> of_file(std::vector<Row<T>> rows) {
  rows.insert(rows.begin(), {{keys::text("$schema", "where editors find this kind of file's schema")},
                             {keys::format(1), nullptr, [](const T&, bool) { return json_number(1); }}});
  return rows;
}

template <class T>
struct Rows {
  using R = Row<T>;
  using Each = std::function<void(const JsonObject& item, T& t, Context& c)>;

  /// A row without a member, or with functions of its own.
  static R own(Key key, decltype(R::read) read = nullptr, decltype(R::write) write = nullptr) {
    return {std::move(key), std::move(read), std::move(write)};
  }

  template <class M>
  static R number(const std::string& name, Unit unit, M member, double low, double high, const std::string& meaning) {
    return plain(
        keys::number(name, low, high, said(meaning, [&] { return in_file(unit, usual(member)); })), member,
        [=](const JsonObject& o) { return unit.read(o.number(name)); },
        [=](double v) { return json_number(in_file(unit, v)); });
  }
  template <class M>
  static R integer(const std::string& name, M member, int low, int high, const std::string& meaning) {
    return plain(
        keys::integer(name, low, high, said(meaning, [&] { return usual(member); })), member,
        [=](const JsonObject& o) { return o.integer(name); }, [](int v) { return json_number(v); });
  }
  template <class M>
  static R flag(const std::string& name, M member, const std::string& meaning) {
    return plain(
        keys::flag(name, said(meaning, [&] { return usual(member); })), member,
        [=](const JsonObject& o) { return o.flag(name); }, json_flag);
  }
  /// An enumerator, or whatever else has a name.
  template <class M, class E>
  static R choice(const std::string& name, const Choices<E>& choices, M member, const std::string& meaning) {
    const auto word = [choices](E v) -> std::string {
      for (const auto& [text, e] : choices)
        if (e == v) return text;
      return "";
    };
    const auto meant = [choices](const std::string& word_in_file) {
      for (const auto& [text, e] : choices)
        if (word_in_file == text) return e;
      return E{};
    };
    std::vector<std::string> words;
    for (const auto& [text, e] : choices) words.emplace_back(text);
    return plain(
        keys::choice(name, words, said(meaning, [&] { return word(usual(member)); })), member,
        [=](const JsonObject& o) { return meant(o.text(name)); }, [=](E v) { return json_text(word(v)); });
  }
  template <class M>
  static R numbers(const std::string& name, M member, double low, double high, std::size_t at_least,
                   const std::string& meaning) {
    return plain(
        keys::numbers(name, low, high, at_least, meaning), member, [=](const JsonObject& o) { return o.numbers(name); },
        [](const std::vector<double>& values) { return listed(values, json_number); });
  }
  template <class M>
  static R text(const std::string& name, M member, const std::string& meaning) {
    return texty(keys::text(name, meaning), member);
  }
  template <class M>
  static R name(const std::string& name, M member, const std::string& meaning) {
    return texty(keys::name(name, meaning), member);
  }
  /// A name of something else.
  template <class M>
  static R ref(const std::string& name, Reference::To to, M member, const std::string& meaning) {
    R row = texty(keys::name(name, meaning), member);
    row.read = [=, read = row.read](const JsonObject& o, T& t, Context& c) {
      read(o, t, c);
      if (o.has(name)) c.references.push_back({to, o.text(name), o.at(name)});
    };
    return row;
  }
  template <class M>
  static R texts(const std::string& name, M member, const std::string& meaning) {
    return plain(
        keys::texts(name, meaning), member, [=](const JsonObject& o) { return o.texts(name); },
        [](const std::vector<std::string>& texts) { return listed(texts, json_text); });
  }
  template <class M>
  static R refs(const std::string& name, Reference::To to, M member, const std::string& meaning) {
    R row = texts(name, member, meaning);
    row.read = [=, read = row.read](const JsonObject& o, T& t, Context& c) {
      read(o, t, c);
      const std::vector<std::string>& names = std::invoke(member, t);
      for (std::size_t i = 0; i < names.size(); ++i) c.references.push_back({to, names[i], o.at(name, i)});
    };
    return row;
  }
  template <class M>
  static R vec3(const std::string& name, Unit unit, M member, double low, double high, const std::string& meaning) {
    return plain(
        keys::vec3(name, low, high, meaning), member, [=](const JsonObject& o) { return read_by(unit, o.vec3(name)); },
        [=](Vec3d v) { return written_by(unit, v); });
  }
  template <class M>
  static R points(const std::string& name, Unit unit, M member, double low, double high, std::size_t at_least,
                  const std::string& meaning) {
    return plain(
        keys::points(name, low, high, at_least, meaning), member,
        [=](const JsonObject& o) {
          std::vector<Vec3d> points = o.points(name);
          for (Vec3d& p : points) p = read_by(unit, p);
          return points;
        },
        [=](const std::vector<Vec3d>& points) {
          return listed(points, [unit](Vec3d p) { return written_by(unit, p); });
        });
  }
  /// Lines of points, which need not have as many each.
  template <class M>
  static R lines(const std::string& name, Unit unit, M member, double low, double high, std::size_t at_least,
                 const std::string& meaning) {
    return plain(
        keys::lines(name, low, high, at_least, meaning), member,
        [=](const JsonObject& o) {
          std::vector<std::vector<Vec3d>> lines = o.lines(name);
          for (std::vector<Vec3d>& line : lines)
            for (Vec3d& p : line) p = read_by(unit, p);
          return lines;
        },
        [=](const std::vector<std::vector<Vec3d>>& lines) {
          return listed(lines, [unit](const std::vector<Vec3d>& line) {
            return listed(line, [unit](Vec3d p) { return written_by(unit, p); });
          });
        });
  }
  /// An object; an optional member is there where the file names it, of another what is at its default is not written.
  template <class Item, class M>
  static R object(const std::string& name, const Table<Item>& (*table)(), M member, const std::string& meaning) {
    return {keys::object(
                name, [table]() -> const Shape& { return table(); }, meaning),
            [=](const JsonObject& o, T& t, Context& c) {
              for (const JsonObject& part : o.objects(name)) table().read(part, made(std::invoke(member, t)), c);
            },
            [=](const T& t, bool needed) -> std::optional<JsonValue> {
              const auto& part = std::invoke(member, t);
              if constexpr (requires { part.has_value(); }) {
                return unless(!part.has_value(), [&] { return table().written(*part); });
              } else {
                JsonValue o = table().written(part);
                return unless(!needed && o.members.empty(), [&] { return std::move(o); });
              }
            }};
  }
  /// @param each  called with every item of the file when it has been read into the member's last
  template <class Item, class M>
  static R objects(const std::string& name, const Table<Item>& (*table)(), M member, std::size_t at_least,
                   const std::string& meaning, Each each = nullptr) {
    return {keys::objects(
                name, [table]() -> const Shape& { return table(); }, at_least, meaning),
            [=](const JsonObject& o, T& t, Context& c) {
              for (const JsonObject& part : o.objects(name)) {
                std::invoke(member, t).push_back(table().made(part, c));
                if (each) each(part, t, c);
              }
            },
            [=](const T& t, bool needed) {
              const auto& items = std::invoke(member, t);
              return unless(items.empty() && !needed,
                            [&] { return listed(items, [&](const Item& item) { return table().written(item); }); });
            }};
  }

 private:
  /// The member's default.
  template <class M>
  static const auto& usual(M member) {
    static const T t{};
    return std::invoke(member, t);
  }
  template <class Value>
  static std::string said(const std::string& meaning, Value&& value) {
    return meaning.find('{') == meaning.npos ? meaning : fmt::format(fmt::runtime(meaning), value());
  }
  template <class Value>
  static std::optional<JsonValue> unless(bool not_at_all, Value&& value) {
    return not_at_all ? std::nullopt : std::optional<JsonValue>(value());
  }
  template <class M>
  static R texty(Key key, M member) {
    const std::string name = key.name;
    R row = plain(
        std::move(key), member, [=](const JsonObject& o) { return o.text(name); }, json_text);
    row.write = [=, write = row.write](const T& t, bool needed) {
      return needed || !std::invoke(member, t).empty() ? write(t, true) : std::nullopt;
    };
    return row;
  }
  /// What is read keeps its default where the file says nothing valid; what has it is not written.
  template <class M, class Read, class Write>
  static R plain(Key key, M member, Read read, Write write) {
    const std::string name = key.name;
    return {std::move(key),
            [=](const JsonObject& o, T& t, Context&) {
              if (o.has(name)) std::invoke(member, t) = read(o);
            },
            [=](const T& t, bool needed) {
              const auto& v = std::invoke(member, t);
              return unless(!needed && v == usual(member), [&] { return write(v); });
            }};
  }
  template <class Part>
  static Part& made(Part& part) {
    return part;
  }
  template <class Part>
  static Part& made(std::optional<Part>& part) {
    return part.emplace();
  }
};

}  // namespace trocar::scene
