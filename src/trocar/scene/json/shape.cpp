#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/scene/json/shape.hpp>

namespace trocar::scene {
namespace {

using Kind = JsonValue::Kind;
using Type = Key::Type;

Key row(std::string name, Type type, std::string meaning) {
  Key key;
  key.name = std::move(name);
  key.type = type;
  key.meaning = std::move(meaning);
  return key;
}

Key ranged(std::string name, Type type, double low, double high, std::string meaning) {
  Key key = row(std::move(name), type, std::move(meaning));
  key.low = low;
  key.high = high;
  return key;
}

std::string article(std::string_view word) {
  const bool vowel = !word.empty() && std::string_view("aeiou").find(word[0]) != std::string_view::npos;
  return fmt::format("{} {}", vowel ? "an" : "a", word);
}

std::string joined(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

/// At most kShownNames of them, each once.
std::string shortened(const std::vector<std::string>& words) {
  constexpr std::size_t kShownNames = 12;
  std::vector<std::string> once;
  std::set<std::string_view> seen;
  for (const std::string& word : words)
    if (seen.insert(word).second && once.size() <= kShownNames) once.push_back(word);
  if (seen.size() <= kShownNames + 1) return joined(once);
  once.resize(kShownNames);
  return tr("{} and {} more", joined(once), seen.size() - kShownNames);
}

bool is_name(std::string_view text) {
  if (text.empty() || text.size() > 64) return false;
  return std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

constexpr std::size_t kLongestGuess = 64;     ///< [bytes] a longer word is no misspelt name
constexpr std::size_t kMostCandidates = 256;  ///< that are looked through for what was meant

/// Damerau-Levenshtein distance restricted to adjacent swaps ("optimal string alignment"), of words that are no longer
/// than twice kLongestGuess; `most` or more where it is not below that.
std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t most) {
  const std::size_t apart = a.size() > b.size() ? a.size() - b.size() : b.size() - a.size();
  if (apart >= most || b.size() > 2 * kLongestGuess) return std::max(apart, most);
  std::array<std::array<std::size_t, 2 * kLongestGuess + 1>, 3> rows{};  // of a: two before, one before, at hand
  for (std::size_t j = 0; j <= b.size(); ++j) rows[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    const auto &before = rows[(i - 1) % 3], &earlier = rows[(i + 1) % 3];
    auto& row = rows[i % 3];
    std::size_t least = row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = a[i - 1] == b[j - 1] ? 0 : 1;
      row[j] = std::min({before[j] + 1, row[j - 1] + 1, before[j - 1] + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], earlier[j - 2] + 1);
      least = std::min(least, row[j]);
    }
    if (least > most) return least;  // a swap takes one back at most
  }
  return rows[a.size() % 3][b.size()];
}

/// Checks one value against one row of a table; faults go to the value's own place.
class Check {
 public:
  Check(const Key& key, const std::string& file, std::vector<core::Fault>& faults)
      : m_key(key), m_file(file), m_faults(faults) {}

  bool operator()(const JsonValue& value) const {
    switch (m_key.type) {
      case Type::number:
        return number(value);
      case Type::integer:
        return integer(value);
      case Type::flag:
        return value.kind == Kind::boolean || wrong(value, "true or false");
      case Type::text:
        return text(value);
      case Type::name:
        return name(value);
      case Type::texts:
        return list(value, [this](const JsonValue& v) { return text(v); });
      case Type::vec3:
        return vec3(value);
      case Type::points:
        return list(value, [this](const JsonValue& v) { return vec3(v); });
      case Type::lines:
        return lines(value);
      case Type::grid:
        return rows(value, "points", [this](const JsonValue& v) { return vec3(v); });
      case Type::numbers:
        return list(value, [this](const JsonValue& v) { return number(v); });
      case Type::table:
        return rows(value, "numbers", [this](const JsonValue& v) { return number(v); });
      case Type::object:
        return value.kind == Kind::object || wrong(value, article(m_key.shape().name) + " in {}");
      case Type::objects:
        return list(value, [this](const JsonValue& v) { return object(v); });
      case Type::includes:
        return list(value, [this](const JsonValue& v) { return v.kind == Kind::string || object(v); });
      case Type::any:
        return value.kind != Kind::broken;
    }
    return false;
  }

 private:
  const Key& m_key;
  const std::string& m_file;
  std::vector<core::Fault>& m_faults;

  bool wrong(const JsonValue& value, const std::string& expected) const {
    if (value.kind == Kind::broken) return false;  // told already
    tell(m_faults, {{m_file, value.line, value.column},
                    tr("expected {} for \"{}\", got {}", expected, m_key.name, shown(value))});
    return false;
  }

  std::string range() const {
    if (m_key.low == m_key.high) return fmt::format("{}", m_key.low);
    return fmt::format("in [{}, {}]", m_key.low, m_key.high);
  }

  bool number(const JsonValue& value) const {
    const bool good = value.kind == Kind::number && value.number >= m_key.low && value.number <= m_key.high;
    return good || wrong(value, "a number " + range());
  }
  bool integer(const JsonValue& value) const {
    const bool good = value.kind == Kind::number && value.number >= m_key.low && value.number <= m_key.high &&
                      value.number == std::floor(value.number);
    return good || wrong(value, m_key.low == m_key.high ? range() : "a whole number " + range());
  }
  bool text(const JsonValue& value) const {
    if (value.kind != Kind::string) return wrong(value, "a string");
    if (m_key.choices.empty()) return true;
    if (std::find(m_key.choices.begin(), m_key.choices.end(), value.text) != m_key.choices.end()) return true;
    const std::string guess = nearest(value.text, m_key.choices);
    tell(m_faults, {{m_file, value.line, value.column},
                    tr("expected one of {} for \"{}\", got {}{}", joined(m_key.choices), m_key.name, shown(value),
                       guess.empty() ? "" : tr(" (did you mean \"{}\"?)", guess))});
    return false;
  }
  bool name(const JsonValue& value) const {
    return (value.kind == Kind::string && is_name(value.text)) ||
           wrong(value, "a name (1 to 64 letters, digits, _ or -)");
  }
  bool vec3(const JsonValue& value) const {
    if (value.kind != Kind::array || value.items.size() != 3) {
      if (value.kind != Kind::array) return wrong(value, "an array of three numbers");
      tell(m_faults,
           {{m_file, value.line, value.column},
            tr("expected an array of three numbers for \"{}\", got {} items", m_key.name, value.items.size())});
      return false;
    }
    bool good = true;
    for (const JsonValue& component : value.items) good = number(component) && good;
    return good;
  }
  bool object(const JsonValue& value) const {
    return value.kind == Kind::object || wrong(value, article(m_key.shape().name) + " in {}");
  }
  template <class Item>
  bool list(const JsonValue& value, Item&& item) const {
    return list(value, m_key.min_count, item);
  }
  template <class Item>
  bool list(const JsonValue& value, std::size_t at_least, Item&& item) const {
    if (value.kind != Kind::array) return wrong(value, "an array");
    const std::size_t count = value.items.size();
    const bool few = count < at_least;
    const bool many = count > m_key.max_count;
    bool good = true;
    for (std::size_t i = 0; i < count && !many; ++i) good = item(value.items[i]) && good;
    if (!few && !many) return good;
    tell(m_faults, {{m_file, value.line, value.column},
                    tr("expected at {} {} items for \"{}\", got {}", few ? "least" : "most",
                       few ? at_least : m_key.max_count, m_key.name, count)});
    return false;
  }
  bool lines(const JsonValue& value) const {
    return list(value, 1, [this](const JsonValue& line) {
      if (line.kind != Kind::array) return wrong(line, "a line of points");
      return list(line, [this](const JsonValue& v) { return vec3(v); });
    });
  }
  /// All of one length.
  template <class Item>
  bool rows(const JsonValue& value, const char* of, Item&& item) const {
    std::size_t columns = 0;
    return list(value, [&](const JsonValue& line) {
      if (line.kind != Kind::array) return wrong(line, fmt::format("a row of {}", of));
      bool good = list(line, item);
      if (columns == 0) columns = line.items.size();
      if (line.items.size() != columns) {
        tell(m_faults,
             {{m_file, line.line, line.column},
              tr("expected rows of {} {} for \"{}\", got a row of {}", columns, of, m_key.name, line.items.size())});
        good = false;
      }
      return good;
    });
  }
};

Vec3d to_vec3(const JsonValue& v) { return {v.items[0].number, v.items[1].number, v.items[2].number}; }

}  // namespace

const Key* Shape::find(std::string_view key) const {
  for (const Key& k : keys)
    if (k.name == key) return &k;
  return nullptr;
}

namespace keys {
Key number(std::string name, double low, double high, std::string meaning) {
  return ranged(std::move(name), Type::number, low, high, std::move(meaning));
}
Key integer(std::string name, int low, int high, std::string meaning) {
  return ranged(std::move(name), Type::integer, low, high, std::move(meaning));
}
Key flag(std::string name, std::string meaning) { return row(std::move(name), Type::flag, std::move(meaning)); }
Key text(std::string name, std::string meaning) { return row(std::move(name), Type::text, std::move(meaning)); }
Key name(std::string name, std::string meaning) { return row(std::move(name), Type::name, std::move(meaning)); }
Key texts(std::string name, std::string meaning) { return row(std::move(name), Type::texts, std::move(meaning)); }
Key choice(std::string name, std::vector<std::string> choices, std::string meaning) {
  Key key = row(std::move(name), Type::text, std::move(meaning));
  key.choices = std::move(choices);
  return key;
}
Key vec3(std::string name, double low, double high, std::string meaning) {
  return ranged(std::move(name), Type::vec3, low, high, std::move(meaning));
}
Key points(std::string name, double low, double high, std::size_t min_count, std::string meaning) {
  Key key = ranged(std::move(name), Type::points, low, high, std::move(meaning));
  key.min_count = min_count;
  return key;
}
Key lines(std::string name, double low, double high, std::size_t min_count, std::string meaning) {
  Key key = ranged(std::move(name), Type::lines, low, high, std::move(meaning));
  key.min_count = min_count;
  return key;
}
Key grid(std::string name, double low, double high, std::size_t min_count, std::string meaning) {
  Key key = ranged(std::move(name), Type::grid, low, high, std::move(meaning));
  key.min_count = min_count;
  return key;
}
Key numbers(std::string name, double low, double high, std::size_t min_count, std::string meaning) {
  Key key = ranged(std::move(name), Type::numbers, low, high, std::move(meaning));
  key.min_count = min_count;
  return key;
}
Key table(std::string name, double low, double high, std::size_t min_count, std::string meaning) {
  Key key = ranged(std::move(name), Type::table, low, high, std::move(meaning));
  key.min_count = min_count;
  return key;
}
Key object(std::string name, std::function<const Shape&()> shape, std::string meaning) {
  Key key = row(std::move(name), Type::object, std::move(meaning));
  key.shape = std::move(shape);
  return key;
}
Key objects(std::string name, std::function<const Shape&()> shape, std::size_t min_count, std::string meaning) {
  Key key = row(std::move(name), Type::objects, std::move(meaning));
  key.shape = std::move(shape);
  key.min_count = min_count;
  return key;
}
Key includes(std::string name, std::function<const Shape&()> shape, std::string meaning) {
  Key key = row(std::move(name), Type::includes, std::move(meaning));
  key.shape = std::move(shape);
  return key;
}
Key any(std::string name, std::string meaning) { return row(std::move(name), Type::any, std::move(meaning)); }
Key format(int version) { return needed(integer("format", version, version, "version of this kind of file")); }
}  // namespace keys

Key needed(Key key) {
  key.required = true;
  return key;
}
Key at_most(std::size_t count, Key items) {
  items.max_count = count;
  return items;
}

JsonObject::JsonObject(const JsonValue& value, const Shape& shape, const std::string& file,
                       std::vector<core::Fault>& faults)
    : m_value(&value), m_shape(&shape), m_file(&file), m_faults(&faults), m_good(shape.keys.size(), 0) {
  if (value.kind == Kind::object)
    check_keys();
  else if (value.kind != Kind::broken)
    fault(at(), tr("expected {} in {{}}, got {}", article(shape.name), shown(value)));
}

void JsonObject::check_keys() {
  for (const JsonMember& member : m_value->members) {
    const Key* key = m_shape->find(member.key);
    if (!key) {
      check_unknown(member);
      continue;
    }
    m_good[std::size_t(key - m_shape->keys.data())] = Check(*key, *m_file, *m_faults)(member.value) ? 1 : 0;
  }
  for (const Key& key : m_shape->keys)
    if (key.required && !m_value->find(key.name))
      fault(at(), tr("expected the key \"{}\" ({}) in this {}, got none", key.name, key.meaning, m_shape->name));
}

void JsonObject::check_unknown(const JsonMember& member) {
  if (m_faults->size() > kMaxFaults) return;  // looking for what was meant is dear
  std::vector<std::string> known;
  for (const Key& key : m_shape->keys) known.push_back(key.name);
  fault({*m_file, member.line, member.column}, unknown_name("key of " + article(m_shape->name), member.key, known));
}

const JsonValue* JsonObject::good(std::string_view key) const {
  const Key* k = m_shape->find(key);
  if (!k || !m_good[std::size_t(k - m_shape->keys.data())]) return nullptr;
  return &m_value->find(key)->value;
}

bool JsonObject::has(std::string_view key) const { return good(key) != nullptr; }
bool JsonObject::names(std::string_view key) const {
  return m_value->kind != Kind::broken && m_value->find(key) != nullptr;
}

double JsonObject::number(std::string_view key, double fallback) const {
  const JsonValue* v = good(key);
  return v ? v->number : fallback;
}
int JsonObject::integer(std::string_view key, int fallback) const {
  const JsonValue* v = good(key);
  return v ? int(v->number) : fallback;
}
bool JsonObject::flag(std::string_view key, bool fallback) const {
  const JsonValue* v = good(key);
  return v ? v->truth : fallback;
}
std::string JsonObject::text(std::string_view key, const std::string& fallback) const {
  const JsonValue* v = good(key);
  return v ? v->text : fallback;
}
std::vector<std::string> JsonObject::texts(std::string_view key) const {
  std::vector<std::string> all;
  if (const JsonValue* v = good(key))
    for (const JsonValue& item : v->items) all.push_back(item.text);
  return all;
}
Vec3d JsonObject::vec3(std::string_view key, Vec3d fallback) const {
  const JsonValue* v = good(key);
  return v ? to_vec3(*v) : fallback;
}
std::vector<Vec3d> JsonObject::points(std::string_view key) const {
  std::vector<Vec3d> all;
  if (const JsonValue* v = good(key))
    for (const JsonValue& item : v->items) all.push_back(to_vec3(item));
  return all;
}
std::vector<std::vector<Vec3d>> JsonObject::lines(std::string_view key) const {
  std::vector<std::vector<Vec3d>> all;
  const JsonValue* v = good(key);
  if (!v) return all;
  for (const JsonValue& line : v->items) {
    all.emplace_back();
    for (const JsonValue& point : line.items) all.back().push_back(to_vec3(point));
  }
  return all;
}
PointGrid JsonObject::grid(std::string_view key) const {
  PointGrid grid;
  const JsonValue* v = good(key);
  if (!v) return grid;
  grid.rows = v->items.size();
  grid.columns = grid.rows == 0 ? 0 : v->items[0].items.size();
  for (const JsonValue& line : v->items)
    for (const JsonValue& point : line.items) grid.points.push_back(to_vec3(point));
  return grid;
}
std::vector<double> JsonObject::numbers(std::string_view key) const {
  std::vector<double> all;
  if (const JsonValue* v = good(key))
    for (const JsonValue& item : v->items) all.push_back(item.number);
  return all;
}
NumberTable JsonObject::table(std::string_view key) const {
  NumberTable table;
  const JsonValue* v = good(key);
  if (!v) return table;
  table.rows = v->items.size();
  table.columns = table.rows == 0 ? 0 : v->items[0].items.size();
  for (const JsonValue& line : v->items)
    for (const JsonValue& item : line.items) table.values.push_back(item.number);
  return table;
}

std::vector<JsonObject> JsonObject::objects(std::string_view key) const {
  std::vector<JsonObject> all;
  const Key* k = m_shape->find(key);
  const JsonMember* member = m_value->find(key);
  if (!k || !member) return all;
  const JsonValue& v = member->value;
  if (k->type == Type::object) {
    if (v.kind == Kind::object) all.emplace_back(v, k->shape(), *m_file, *m_faults);
    return all;
  }
  for (std::size_t i = 0; i < std::min(v.items.size(), k->max_count); ++i)
    if (v.items[i].kind == Kind::object) all.emplace_back(v.items[i], k->shape(), *m_file, *m_faults);
  return all;
}

const std::vector<JsonValue>& JsonObject::values(std::string_view key) const {
  static const std::vector<JsonValue> none;
  const JsonMember* member = m_value->kind == Kind::broken ? nullptr : m_value->find(key);
  return member ? member->value.items : none;
}

core::Location JsonObject::at() const { return {*m_file, m_value->line, m_value->column}; }
core::Location JsonObject::at(std::string_view key) const {
  const JsonMember* member = m_value->find(key);
  return member ? core::Location{*m_file, member->value.line, member->value.column} : at();
}
core::Location JsonObject::at(std::string_view key, std::size_t item) const {
  const std::vector<JsonValue>& items = values(key);
  return item < items.size() ? core::Location{*m_file, items[item].line, items[item].column} : at(key);
}
void JsonObject::fault(core::Location where, std::string message) const {
  tell(*m_faults, {std::move(where), std::move(message)});
}
void JsonObject::fault(std::string_view key, std::string message) const { fault(at(key), std::move(message)); }

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  if (word.size() > kLongestGuess) return {};
  const std::string* best = nullptr;
  std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
  const bool is_leaf = word.find('/') == word.npos;
  for (std::size_t i = 0; i < std::min(candidates.size(), kMostCandidates); ++i) {
    const std::string& candidate = candidates[i];
    const std::size_t slash = candidate.rfind('/');
    std::size_t distance = edit_distance(word, candidate, best_distance);
    if (is_leaf && slash != candidate.npos)
      distance = std::min(distance, edit_distance(word, std::string_view(candidate).substr(slash + 1), best_distance));
    if (distance >= best_distance) continue;
    best = &candidate;
    best_distance = distance;
  }
  return best ? *best : std::string();
}

std::string unknown_name(std::string_view what, std::string_view word, const std::vector<std::string>& known) {
  JsonValue value;
  value.kind = Kind::string;
  value.text = std::string(word);
  if (known.empty()) return tr("expected {}, got {}; none is known", article(what), shown(value));
  const std::string guess = nearest(word, known);
  return tr("expected a known {}, got {}{}; known: {}", what, shown(value),
            guess.empty() ? "" : tr(" (did you mean \"{}\"?)", guess), shortened(known));
}

}  // namespace trocar::scene
